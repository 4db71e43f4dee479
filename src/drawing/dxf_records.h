#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec2.h"

/// The grammar of DXF: pairs of lines, a group code and its value; the code 0 begins a record.
namespace keyblock::drawing {

struct Pair {
  int code = 0;
  std::string_view value;
  int line = 0;  ///< of the value
};

struct Record {
  std::string_view type;
  int line = 0;
  std::span<const Pair> pairs;  ///< after the type

  [[nodiscard]] const Pair* find(int code) const;
  [[nodiscard]] std::string_view text(int code) const;  ///< empty where it is not there
};

/// The records of a file, and the pairs that they are spans of.
struct Records {
  std::vector<Pair> pairs;
  std::vector<Record> records;
};

/// Throws InputError for a group code that is no whole number, and a file without its end.
Records read_records(std::string_view text, const std::string& file);

/// Numbers of records. Throw InputError for what is no finite number.
class Numbers {
 public:
  explicit Numbers(const std::string& file) : file_(file) {}
  [[nodiscard]] double number(const Pair& pair) const;
  [[nodiscard]] double number(const Record& record, int code, double fallback) const;
  [[nodiscard]] int integer(const Record& record, int code, int fallback) const;
  /// x at the code, y at the code + 10; 0 where they are not there.
  [[nodiscard]] Vec2 point(const Record& record, int code) const;
  [[nodiscard]] std::vector<double> all(const Record& record, int code) const;
  /// Every point of this code, in their order. An x without y has y = 0.
  [[nodiscard]] std::vector<Vec2> points(const Record& record, int code) const;

 private:
  const std::string& file_;
};

}  // namespace keyblock::drawing
