#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "loading/motion_direction.h"
#include "loading/motion_file.h"
#include "loading/motion_text.h"
#include "loading/motion_units.h"

namespace keyblock::loading {

/// Numbers in columns of fixed width, as Fortran wrote them: they may touch each other.
struct FixedColumns {
  std::size_t first_width, width;  ///< characters of the first column; of the others

  /// In column `column` of a line, counted from 0; absent where it is blank or no number.
  [[nodiscard]] std::optional<double> number(const MotionText& text, std::size_t line,
                                             std::size_t column) const;
  /// Throws InputError where it is.
  [[nodiscard]] double required(const MotionText& text, std::size_t line, std::size_t column) const;
  /// `count` of them from line `first` on, `per_line` in each. Throws InputError; `what` they are is for the message.
  [[nodiscard]] std::vector<double> numbers(const MotionText& text, std::size_t first, std::size_t count,
                                            std::size_t per_line, const std::string& what) const;

 private:
  [[nodiscard]] std::size_t begin(std::size_t column) const;
};

/// Times and samples from numbers in turn. `line` of a pair is for messages. Throws InputError where times do not ascend.
void set_pairs(const MotionText& text, const std::vector<double>& pairs,
               const std::function<std::size_t(std::size_t)>& line, const AccelerationUnit& unit,
               const MotionDirection& direction, MotionComponent& component);

}  // namespace keyblock::loading
