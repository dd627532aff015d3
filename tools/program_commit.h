// Which commit this program was built from: "1a2b3c4", "1a2b3c4-dirty", or "unknown" outside a checkout.
#pragma once

namespace omnihil {

const char* program_commit();

}  // namespace omnihil
