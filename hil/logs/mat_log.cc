// MATLAB's .mat of versions 4 to 7.3, by libmatio: vectors of one length as the rows of a table.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <matio.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "hil/logs/log_formats.h"

namespace omnihil {
namespace {

constexpr std::size_t kMostColumns =
    16;  // of a matrix that is taken column by column; wider ones are pictures or the like
constexpr int kMostDepth = 8;  // of structs in structs

template <typename T>
void append(const matvar_t& v, std::size_t from, std::size_t count, std::vector<double>& out) {
  const T* data = static_cast<const T*>(v.data);
  for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<double>(data[from + i]));
}

// `count` elements from `from` on; false: of a class that is no number.
bool append_values(const matvar_t& v, std::size_t from, std::size_t count, std::vector<double>& out) {
  switch (v.data_type) {
    case MAT_T_DOUBLE:
      append<double>(v, from, count, out);
      return true;
    case MAT_T_SINGLE:
      append<float>(v, from, count, out);
      return true;
    case MAT_T_INT8:
      append<std::int8_t>(v, from, count, out);
      return true;
    case MAT_T_UINT8:
      append<std::uint8_t>(v, from, count, out);
      return true;
    case MAT_T_INT16:
      append<std::int16_t>(v, from, count, out);
      return true;
    case MAT_T_UINT16:
      append<std::uint16_t>(v, from, count, out);
      return true;
    case MAT_T_INT32:
      append<std::int32_t>(v, from, count, out);
      return true;
    case MAT_T_UINT32:
      append<std::uint32_t>(v, from, count, out);
      return true;
    case MAT_T_INT64:
      append<std::int64_t>(v, from, count, out);
      return true;
    case MAT_T_UINT64:
      append<std::uint64_t>(v, from, count, out);
      return true;
    default:
      return false;
  }
}

class MatWalk {
 public:
  std::vector<LogSeries> found;
  std::vector<std::string> left_out;

  void take(const matvar_t& v, const std::string& name, int depth) {
    if (v.class_type == MAT_C_STRUCT && depth < kMostDepth) return take_struct(v, name, depth);
    const bool number = v.class_type >= MAT_C_DOUBLE && v.class_type <= MAT_C_UINT64;
    if (!number || v.isComplex != 0 || v.rank != 2 || v.data == nullptr || v.dims[0] * v.dims[1] < 2) {
      left_out.push_back(name);
      return;
    }
    const bool lies = v.dims[0] == 1;
    const std::size_t rows = lies ? v.dims[1] : v.dims[0], columns = lies ? 1 : v.dims[1];
    if (columns > kMostColumns || columns >= rows) {
      left_out.push_back(name);
      return;
    }
    for (std::size_t c = 0; c < columns; ++c) {  // columns stand one after another
      LogSeries s;
      s.name = columns == 1 ? name : fmt::format("{}[{}]", name, c + 1);
      if (!append_values(v, c * rows, rows, s.value)) return left_out.push_back(name);
      found.push_back(std::move(s));
    }
  }

 private:
  void take_struct(const matvar_t& v, const std::string& name, int depth) {
    // matio's readers of fields do not write, but take no const.
    auto* st = const_cast<matvar_t*>(&v);
    const std::size_t elements = v.rank == 2 ? v.dims[0] * v.dims[1] : 0;
    char* const* names = Mat_VarGetStructFieldnames(&v);
    for (std::size_t e = 0; e < elements; ++e) {
      const std::string base = elements == 1 ? name : fmt::format("{}[{}]", name, e + 1);
      for (unsigned f = 0; f < Mat_VarGetNumberOfFields(st); ++f) {
        const matvar_t* field = Mat_VarGetStructFieldByIndex(st, f, e);
        if (field != nullptr) take(*field, base + "." + names[f], depth + 1);
      }
    }
  }
};

// The rows of the table: what most vectors are as long as.
std::size_t common_length(const std::vector<LogSeries>& series) {
  std::map<std::size_t, std::size_t> counts;
  for (const LogSeries& s : series) ++counts[s.value.size()];
  std::size_t best = 0;
  for (const auto& [length, count] : counts) {
    if (best == 0 || count > counts[best] || (count == counts[best] && length > best)) best = length;
  }
  return best;
}

}  // namespace

LogTable read_mat_log(const std::string& path) {
  Mat_LogInitFunc("omnihil", [](int, char*) {});  // what is wrong is said here
  const std::unique_ptr<mat_t, int (*)(mat_t*)> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY), Mat_Close);
  if (!file) throw BadLog(path + ": is no .mat file that libmatio reads; allowed: versions 4, 5 and 7.3");
  MatWalk walk;
  for (;;) {
    const std::unique_ptr<matvar_t, void (*)(matvar_t*)> v(Mat_VarReadNext(file.get()), Mat_VarFree);
    if (!v) break;
    walk.take(*v, v->name != nullptr ? v->name : "?", 0);
  }
  LogTable log;
  log.format = LogFormat::kMat;
  const std::size_t rows = common_length(walk.found);
  for (LogSeries& s : walk.found) {
    if (s.value.size() == rows) {
      log.series.push_back(std::move(s));
    } else {
      walk.left_out.push_back(fmt::format("{} ({} values)", s.name, s.value.size()));
    }
  }
  if (log.series.empty())
    throw BadLog(path + ": has no vectors of numbers; allowed: vectors of one length, also in structs");
  if (!walk.left_out.empty())
    log.notes.push_back(fmt::format("{}: no vectors of {} real numbers, left out: {}", path, rows,
                                    fmt::join(walk.left_out, ", ")));
  return log;
}

}  // namespace omnihil
