#include "scenario/override.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "scenario/key_path.h"

namespace keyblock::scenario {
namespace {

constexpr std::size_t longest_shown = 40;  // characters of a path that is deeper
// Bytes of an override in positions, which each of its values has.
constexpr std::size_t longest_place = 120;

// The beginning of a text in UTF-8, cut between characters.
std::string beginning(const std::string& text) {
  if (text.size() <= longest_place) return text;
  std::size_t end = longest_place;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "…";
}

void move_to(Value& value, const SourcePosition& where) {
  value.where = where;
  value.key_where = where;
  for (Value& item : value.items) move_to(item, where);
}

std::size_t find_equals_sign(const std::string& text) {
  char quote = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (quote == 0 && c == '=') return k;
    if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    }
  }
  return std::string::npos;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Words need no quotes; what begins as a table, a list or a string in quotes is meant as one.
Value value_of_text(const std::string& text, const SourcePosition& where) {
  if (text.find('\n') == std::string::npos) {
    try {
      Value document = parse_toml("value = " + text, "");
      if (document.items.size() == 1) return std::move(document.items.front());
    } catch (const InputError& error) {
      if (!text.empty() && std::string_view("{[\"'").find(text.front()) != std::string_view::npos) {
        Diagnostic diagnostic = error.diagnostics().front();
        diagnostic.where = where;
        diagnostic.expected = "a TOML value; a word that begins like one stands in quotes";
        throw InputError(std::move(diagnostic));
      }
    }
  }
  Value word;
  word.type = Value::Type::string;
  word.text = text;
  return word;
}

Diagnostic no_path(const SourcePosition& where, const std::string& text) {
  Diagnostic diagnostic;
  diagnostic.where = where;
  diagnostic.found = text.empty() ? "no key" : "'" + text + "', which is no key path";
  diagnostic.expected = "a key path as in rock.order or stage.'first earthquake'.scale";
  return diagnostic;
}

// Element of a list by name or place, or null.
const Value* find_element(const Value& list, const PathSegment& segment) {
  for (const Value& item : list.items) {
    const std::string* name = item.name();
    if (name != nullptr && *name == segment.key) return &item;
  }
  return segment.index && *segment.index < list.items.size() ? &list.items[*segment.index] : nullptr;
}

Diagnostic no_element(const Value& list, const PathSegment& segment, const std::string& path) {
  std::vector<std::string> names;
  for (const Value& item : list.items) {
    if (item.name() != nullptr) names.push_back(*item.name());
  }
  Diagnostic diagnostic;
  diagnostic.key = path;
  diagnostic.found = "no element '" + segment.key + "'";
  if (list.items.empty()) {
    diagnostic.expected = "an element that exists (the list is empty)";
  } else {
    const std::string last = std::to_string(list.items.size() - 1);
    diagnostic.expected = names.empty() ? "a place" : list_words(names) + ", or a place";
    diagnostic.expected += " from 0 to " + last;
  }
  diagnostic.hint = suggestion(segment.key, names);
  return diagnostic;
}

// Puts `value` where `slot` is, which keeps its key.
void replace(Value& slot, const Value& value) {
  std::string key = std::move(slot.key);
  slot = value;
  slot.key = std::move(key);
  slot.key_where = value.where;
}

}  // namespace

Override parse_override(const std::string& text) {
  const SourcePosition where{"--set " + beginning(text), 0, 0};
  if (const std::size_t at = find_invalid_utf8(text); at != std::string::npos) {
    Diagnostic diagnostic;
    diagnostic.where = where;
    diagnostic.found = "'" + text.substr(at, 1) + "', which is no UTF-8";
    diagnostic.expected = "text in UTF-8";
    throw InputError(std::move(diagnostic));
  }
  const std::size_t equals = find_equals_sign(text);
  if (equals == std::string::npos) {
    Diagnostic diagnostic;
    diagnostic.where = where;
    diagnostic.found = "no '='";
    diagnostic.expected = "key=value";
    throw InputError(std::move(diagnostic));
  }
  Value value = value_of_text(trimmed(text.substr(equals + 1)), where);
  move_to(value, where);
  return make_override(trimmed(text.substr(0, equals)), std::move(value));
}

Override make_override(const std::string& path, Value value) {
  auto segments = parse_key_path(path);
  if (segments && segments->size() > std::size_t{deepest_path}) {
    Diagnostic diagnostic = no_path(value.where, path.substr(0, longest_shown) + "…");
    diagnostic.expected += fmt::format(", of at most {} keys", deepest_path);
    throw InputError(std::move(diagnostic));
  }
  if (!segments) throw InputError(no_path(value.where, path));
  return {std::move(*segments), std::move(value)};
}

std::optional<Diagnostic> apply_override(const Override& override_, Value& document) {
  Value* node = &document;
  std::string path;
  const auto failed = [&](Diagnostic diagnostic) {
    diagnostic.where = override_.value.where;
    return diagnostic;
  };
  for (const PathSegment& segment : override_.path) {
    if (node->is(Value::Type::array)) {
      const Value* element = find_element(*node, segment);
      if (element == nullptr) return failed(no_element(*node, segment, path));
      const auto place = static_cast<std::size_t>(element - node->items.data());
      path = join_index(path, place);
      node = &node->items[place];
    } else if (node->is(Value::Type::table)) {
      Value* member = node->find(segment.key);
      if (member == nullptr) {
        member = &node->items.emplace_back();
        member->key = segment.key;
        member->where = member->key_where = override_.value.where;
      }
      path = join_path(path, segment.key);
      node = member;
    } else {
      Diagnostic diagnostic;
      diagnostic.key = path;
      diagnostic.found = describe(*node) + ", which has no '" + segment.key + "'";
      diagnostic.expected = "a table or a list where the key path goes on";
      return failed(std::move(diagnostic));
    }
  }
  replace(*node, override_.value);
  return std::nullopt;
}

bool begins_with(const std::vector<PathSegment>& path, const std::vector<PathSegment>& first) {
  return path.size() >= first.size() &&
         std::equal(first.begin(), first.end(), path.begin(), [](const PathSegment& a, const PathSegment& b) {
           return a.key == b.key && a.index == b.index;
         });
}

namespace {

/// What a segment leads to in a table or a list, or null.
const Value* child(const Value& of, const PathSegment& segment) {
  return of.is(Value::Type::array) ? find_element(of, segment) : of.find(segment.key);
}

}  // namespace

const Value* find_value(const std::vector<PathSegment>& path, const Value& document) {
  const Value* node = &document;
  for (const PathSegment& segment : path) {
    if (node == nullptr) break;
    node = child(*node, segment);
  }
  return node;
}

Value* find_value(const std::vector<PathSegment>& path, Value& document) {
  return const_cast<Value*>(find_value(path, static_cast<const Value&>(document)));
}

bool remove_value(std::vector<PathSegment> path, Value& document) {
  if (path.empty()) return false;
  const PathSegment last = std::move(path.back());
  path.pop_back();
  Value* of = find_value(path, document);
  const Value* found = of == nullptr ? nullptr : child(*of, last);
  if (found == nullptr) return false;
  of->items.erase(of->items.begin() + (found - of->items.data()));
  return true;
}

std::vector<std::string> resolved_path(const std::vector<PathSegment>& path, const Value& document) {
  std::vector<std::string> resolved;
  const Value* node = &document;
  for (const PathSegment& segment : path) {
    const bool in_list = node != nullptr && node->is(Value::Type::array);
    const Value* next = node == nullptr ? nullptr : child(*node, segment);
    resolved.push_back(in_list && next != nullptr
                           ? join_index("", static_cast<std::size_t>(next - node->items.data()))
                           : segment.key);
    node = next;
  }
  return resolved;
}

}  // namespace keyblock::scenario
