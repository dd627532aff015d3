// Types and variables of a program, from the debug information (DWARF 2 to 5) in its ELF file.
//
//   std::string problem;
//   std::shared_ptr<const DebugInfo> info = DebugInfo::read(bytes, problem);     // null: problem says why
//   for (const DebugVariable& v : info->variables()) std::cout << v.name << info->type(v.type).name;
//
// What a program has by name: variables outside of functions and static ones inside ("function::name"), in the
// words of C++ where it is C++ ("robot::Wheel::count"). Read with libdw (elfutils); types are worked out when they
// are asked for. Nothing in the file is trusted. Cannot: locals and parameters (they have no place between two
// calls), thread-local variables, debug information in a file of its own.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace omnihil {

enum class ValueKind : std::uint8_t { kSigned, kUnsigned, kBool, kReal, kEnumeration, kPointer };

struct DebugMember {
  std::string
      name;  // empty: a base class, or a struct without a name, whose members count as the outer one's
  int type = -1;
  std::uint64_t offset_bytes = 0;
  unsigned bit_offset = 0, bits = 0;  // of a bit-field, from the byte's lowest bit; bits 0: it is none
};

struct DebugType {
  enum class Form : std::uint8_t { kScalar, kStruct, kArray, kOther };
  Form form = Form::kOther;
  std::string name;  // "float", "struct wheel", "int[4]"
  std::uint64_t bytes = 0;
  ValueKind kind = ValueKind::kUnsigned;                          // kScalar
  std::vector<std::pair<std::string, std::int64_t>> enumerators;  // kEnumeration
  bool negative = false;                                          // kEnumeration: of a signed type
  std::vector<DebugMember> members;                               // kStruct
  int element = -1;                                               // kArray
  std::uint64_t count = 0;                                        // kArray
};

struct DebugVariable {
  std::string name, file;  // `file`: that it is defined in, without folders
  int type = -1;
  std::optional<std::uint64_t> address;
  std::vector<std::uint8_t> constant;  // the value of one that the optimiser made a constant
  bool writable = false;
  std::string why_not;  // it has neither address nor value: in words
};

struct DebugLocal {  // of a function: known by name, and not to be had
  std::string function;
};

class DebugInfo {
 public:
  static std::shared_ptr<const DebugInfo> read(std::vector<std::uint8_t> bytes, std::string& problem);
  virtual ~DebugInfo() = default;

  virtual const std::vector<DebugVariable>& variables() const = 0;  // by name
  virtual const DebugType& type(int index) const = 0;
  // Of a name without its places: the function that has a local or a parameter of it.
  virtual const std::map<std::string, DebugLocal, std::less<>>& locals() const = 0;
  // Structs by tag or typedef name; by size.
  virtual std::optional<int> struct_named(std::string_view name) const = 0;
  virtual std::vector<int> structs_of(std::uint64_t bytes) const = 0;
  // What the file has at an address; empty: nothing (RAM that start-up code clears).
  virtual std::vector<std::uint8_t> initial(std::uint64_t address, std::uint64_t bytes) const = 0;
};

}  // namespace omnihil
