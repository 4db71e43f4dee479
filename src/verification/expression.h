#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace keyblock::verification {

/// What a function of an expression is given.
using Argument = std::variant<double, std::string>;

/// What an expression takes from outside: results of a simulation, parameters, other rows.
class Quantities {
 public:
  virtual ~Quantities() = default;
  /// Throws std::runtime_error, which says what is wrong, when there is no such quantity.
  [[nodiscard]] virtual double get(std::string_view function,
                                   const std::vector<Argument>& arguments) const = 0;
};

/// A text is no expression: what stands at `column` (from 1), and what should.
struct ExpressionError : std::runtime_error {
  ExpressionError(std::size_t at, std::string what, std::string wanted);
  std::size_t column;
  std::string found, expected;
};

/// An arithmetic expression of a case file:
///     sum     = product { (+|-) product }
///     product = sign { (*|/) sign }
///     sign    = (+|-) sign | power
///     power   = atom [ ^ sign ]
///     atom    = number | pi | function ( argument { , argument } ) | ( sum )
/// An argument is a sum or a string in single quotes. Functions of numbers: sqrt abs exp log sin cos tan asin acos atan
/// atan2 hypot min max rad deg; all others are asked of Quantities, see docs/verification.md.
class Expression {
 public:
  /// Throws ExpressionError, also for unknown functions and for arguments they do not take.
  explicit Expression(std::string_view text);
  /// A constant.
  explicit Expression(double value);

  /// Throws what `quantities` throws.
  [[nodiscard]] double evaluate(const Quantities& quantities) const;

 private:
  friend class ExpressionParser;
  struct Node {
    enum class Kind { number, text, negate, add, subtract, multiply, divide, power, call };
    Kind kind = Kind::number;
    double value = 0.0;
    std::string text;                   // a string, or the name of a function
    std::vector<std::size_t> children;  // of nodes_
  };
  [[nodiscard]] double value_of(std::size_t node, const Quantities& quantities) const;
  [[nodiscard]] double call(const Node& node, const Quantities& quantities) const;

  std::vector<Node> nodes_;
  std::size_t root_ = 0;
};

}  // namespace keyblock::verification
