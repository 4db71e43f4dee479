#include "verification/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>

#include "scenario/key_path.h"

namespace keyblock::verification {
namespace {

// A function and what it takes: n for a number, s for a string.
struct Signature {
  std::string_view name, arguments;
};

constexpr Signature signatures[] = {
    // of numbers
    {"sqrt", "n"},
    {"abs", "n"},
    {"exp", "n"},
    {"log", "n"},
    {"sin", "n"},
    {"cos", "n"},
    {"tan", "n"},
    {"asin", "n"},
    {"acos", "n"},
    {"atan", "n"},
    {"atan2", "nn"},
    {"hypot", "nn"},
    {"min", "nn"},
    {"max", "nn"},
    {"rad", "n"},
    {"deg", "n"},
    // of histories
    {"end", "s"},
    {"first", "s"},
    {"at", "sn"},
    {"after", "ss"},
    {"max", "s"},
    {"min", "s"},
    {"maxabs", "s"},
    {"mean", "s"},
    {"crossing", "sn"},
    {"period", "s"},
    // of contacts
    {"normal_force", "ss"},
    {"shear_force", "ss"},
    // of the summary, of the parameters, of other rows, of built-in checks
    {"summary", "s"},
    {"standard_error", "s"},
    {"set", "s"},
    {"order", ""},
    {"row", "ss"},
    {"result", "s"},
};

struct NumberFunction {
  std::string_view name;
  double (*of)(double, double);
};

constexpr NumberFunction number_functions[] = {
    {"sqrt", [](double x, double) { return std::sqrt(x); }},
    {"abs", [](double x, double) { return std::abs(x); }},
    {"exp", [](double x, double) { return std::exp(x); }},
    {"log", [](double x, double) { return std::log(x); }},
    {"sin", [](double x, double) { return std::sin(x); }},
    {"cos", [](double x, double) { return std::cos(x); }},
    {"tan", [](double x, double) { return std::tan(x); }},
    {"asin", [](double x, double) { return std::asin(x); }},
    {"acos", [](double x, double) { return std::acos(x); }},
    {"atan", [](double x, double) { return std::atan(x); }},
    {"atan2", [](double x, double y) { return std::atan2(x, y); }},
    {"hypot", [](double x, double y) { return std::hypot(x, y); }},
    {"min", [](double x, double y) { return std::min(x, y); }},
    {"max", [](double x, double y) { return std::max(x, y); }},
    {"rad", [](double x, double) { return x * std::numbers::pi / 180.0; }},
    {"deg", [](double x, double) { return x * 180.0 / std::numbers::pi; }},
};

std::string usage(std::string_view name) {
  std::string text;
  for (const Signature& signature : signatures) {
    if (signature.name != name) continue;
    std::string arguments;
    for (const char kind : signature.arguments) {
      arguments += (arguments.empty() ? "" : ", ") + std::string(kind == 'n' ? "number" : "'string'");
    }
    text += fmt::format("{}{}({})", text.empty() ? "" : " or ", name, arguments);
  }
  return text;
}

}  // namespace

ExpressionError::ExpressionError(std::size_t at, std::string what, std::string wanted)
    : std::runtime_error(fmt::format("{} at character {}; expected {}", what, at, wanted)),
      column(at),
      found(std::move(what)),
      expected(std::move(wanted)) {}

class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, Expression& expression) : text_(text), out_(expression) {}

  void parse() {
    out_.root_ = sum();
    skip_space();
    if (at_ < text_.size()) fail("an operator or the end");
  }

 private:
  using Node = Expression::Node;

  [[noreturn]] void fail(const std::string& expected) const {
    const std::string found = at_ < text_.size() ? fmt::format("'{}'", text_.substr(at_)) : "the end";
    throw ExpressionError(at_ + 1, found, expected);
  }

  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }

  bool take(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  std::size_t add(Node node) {
    out_.nodes_.push_back(std::move(node));
    return out_.nodes_.size() - 1;
  }

  std::size_t add(Node::Kind kind, std::vector<std::size_t> children) {
    Node node;
    node.kind = kind;
    node.children = std::move(children);
    return add(std::move(node));
  }

  std::size_t sum() {
    std::size_t left = product();
    for (;;) {
      if (take('+')) {
        left = add(Node::Kind::add, {left, product()});
      } else if (take('-')) {
        left = add(Node::Kind::subtract, {left, product()});
      } else {
        return left;
      }
    }
  }

  std::size_t product() {
    std::size_t left = sign();
    for (;;) {
      if (take('*')) {
        left = add(Node::Kind::multiply, {left, sign()});
      } else if (take('/')) {
        left = add(Node::Kind::divide, {left, sign()});
      } else {
        return left;
      }
    }
  }

  std::size_t sign() {
    if (++depth_ > most_depth) fail("an expression that is less deeply nested");
    std::size_t node = 0;
    if (take('-')) {
      node = add(Node::Kind::negate, {sign()});
    } else {
      node = take('+') ? sign() : power();
    }
    --depth_;
    return node;
  }

  std::size_t power() {
    const std::size_t base = atom();
    return take('^') ? add(Node::Kind::power, {base, sign()}) : base;
  }

  std::size_t atom() {
    skip_space();
    if (take('(')) {
      const std::size_t inner = sum();
      if (!take(')')) fail("')'");
      return inner;
    }
    if (at_ < text_.size() && std::isalpha(static_cast<unsigned char>(text_[at_])) != 0) return word();
    return number();
  }

  std::size_t number() {
    Node node;
    const char* begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), node.value);
    if (error != std::errc() || !std::isfinite(node.value)) fail("a number, a function or '('");
    at_ += static_cast<std::size_t>(end - begin);
    return add(std::move(node));
  }

  std::size_t word() {
    const std::size_t start = at_;
    const auto belongs = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    while (at_ < text_.size() && belongs(text_[at_])) ++at_;
    Node node;
    node.text = text_.substr(start, at_ - start);
    if (node.text == "pi") {
      node.value = std::numbers::pi;
      return add(std::move(node));
    }
    node.kind = Node::Kind::call;
    check_function(node.text, start);
    if (!take('(')) fail("'('");
    std::string kinds;
    if (!take(')')) {
      do {
        node.children.push_back(argument(kinds));
      } while (take(','));
      if (!take(')')) fail("',' or ')'");
    }
    const bool known = std::any_of(std::begin(signatures), std::end(signatures), [&](const Signature& s) {
      return s.name == node.text && s.arguments == kinds;
    });
    if (!known) {
      throw ExpressionError(start + 1, fmt::format("'{}'", text_.substr(start, at_ - start)),
                            usage(node.text));
    }
    return add(std::move(node));
  }

  void check_function(const std::string& name, std::size_t start) const {
    std::vector<std::string> names;
    for (const Signature& signature : signatures) names.emplace_back(signature.name);
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    const std::string hint = scenario::suggestion(name, names);
    throw ExpressionError(start + 1, fmt::format("the unknown word '{}'", name),
                          "a function" + (hint.empty() ? "" : "; " + hint));
  }

  std::size_t argument(std::string& kinds) {
    skip_space();
    if (!take('\'')) {
      kinds += 'n';
      return sum();
    }
    const std::size_t end = text_.find('\'', at_);
    if (end == std::string_view::npos) fail("a closing quote");
    Node node;
    node.kind = Node::Kind::text;
    node.text = text_.substr(at_, end - at_);
    at_ = end + 1;
    kinds += 's';
    return add(std::move(node));
  }

  static constexpr int most_depth = 200;
  std::string_view text_;
  Expression& out_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

Expression::Expression(std::string_view text) {
  ExpressionParser(text, *this).parse();
}

Expression::Expression(double value) {
  Node node;
  node.value = value;
  nodes_.push_back(std::move(node));
}

double Expression::evaluate(const Quantities& quantities) const {
  return value_of(root_, quantities);
}

double Expression::value_of(std::size_t index, const Quantities& quantities) const {
  const Node& node = nodes_[index];
  const auto child = [&](std::size_t k) { return value_of(node.children[k], quantities); };
  switch (node.kind) {
    case Node::Kind::negate:
      return -child(0);
    case Node::Kind::add:
      return child(0) + child(1);
    case Node::Kind::subtract:
      return child(0) - child(1);
    case Node::Kind::multiply:
      return child(0) * child(1);
    case Node::Kind::divide:
      return child(0) / child(1);
    case Node::Kind::power:
      return std::pow(child(0), child(1));
    case Node::Kind::call:
      return call(node, quantities);
    case Node::Kind::number:
    case Node::Kind::text:
      break;
  }
  return node.value;
}

double Expression::call(const Node& node, const Quantities& quantities) const {
  std::vector<Argument> arguments;
  bool numbers = true;
  for (const std::size_t child : node.children) {
    if (nodes_[child].kind == Node::Kind::text) {
      arguments.emplace_back(nodes_[child].text);
      numbers = false;
    } else {
      arguments.emplace_back(value_of(child, quantities));
    }
  }
  if (numbers) {
    for (const NumberFunction& function : number_functions) {
      if (function.name != node.text) continue;
      return function.of(std::get<double>(arguments[0]),
                         arguments.size() > 1 ? std::get<double>(arguments[1]) : 0.0);
    }
  }
  return quantities.get(node.text, arguments);
}

}  // namespace keyblock::verification
