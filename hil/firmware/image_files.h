// The two files of an emulated board, image and description, with every fault of both said at once.
//
//   read_image_files(image_file, board_file, read_image, read_board);   // throws std::invalid_argument
//
// The readers add what they find wrong to the list they are given; names of the files are put in front here.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/board/board_context.h"
#include "firmware_iface/mcu/board/board_problem.h"

namespace omnihil {

// The radio formats that there are and the one that a session serves (empty: any); dialects of [wheel_commands] by
// name, those of the program, or by the path of a file, as seen from the board's.
mcu::BoardContext board_context(const std::string& board_file, std::string_view served = {});

using ReadImage =
    std::function<void(std::span<const std::uint8_t> bytes, std::vector<std::string>& problems)>;
using ReadBoard = std::function<void(const std::string& text, std::vector<mcu::BoardProblem>& problems)>;

void read_image_files(const std::string& image_file, const std::string& board_file, const ReadImage& image,
                      const ReadBoard& board);

}  // namespace omnihil
