#include "scenario/key_hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "scenario/key_path.h"
#include "scenario/key_reference.h"
#include "scenario/synonyms.h"

namespace keyblock::scenario {
namespace {

constexpr std::size_t most_sections = 7;  // that are named as those a key belongs to

/// A word as the tables of synonyms have it.
std::string plain(std::string_view word) {
  std::string letters;
  for (const char c : word) {
    if (c != '_' && c != '-' && c != '\'' && c != ' ')
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return letters;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

bool has(const std::vector<std::string>& words, const std::string& word) {
  return std::ranges::find(words, word) != words.end();
}

std::string did_you_mean(const std::string& word) {
  return "did you mean '" + word + "'?";
}

/// The first of `allowed` for which `word` is another word.
std::string synonym_of(const std::string& word, const std::vector<std::string>& allowed) {
  for (const Synonym& synonym : synonyms()) {
    if (!has(words_of(synonym.words), word)) continue;
    for (const std::string& key : words_of(synonym.keys)) {
      if (has(allowed, key)) return key;
    }
  }
  return {};
}

std::string explanation_of(const std::string& word) {
  for (const Explanation& explanation : explanations()) {
    if (has(words_of(explanation.words), word)) return std::string(explanation.text);
  }
  return {};
}

/// Where the keys of all tables belong, and how tables are written.
class Places {
 public:
  Places() {
    for (const SectionReference& section : key_reference()) {
      if (section.title.empty())
        for (const KeyReference& known : section.keys) top_.push_back(known.key);
      if (!section.title.starts_with('[')) continue;
      const std::size_t begin = section.title.find_first_not_of('[');
      titles_[section.title.substr(begin, section.title.find(']') - begin)] = section.title;
      for (const KeyReference& known : section.keys) {
        if (sections_[known.key].empty()) keys_.push_back(known.key);
        sections_[known.key].push_back(section.title);
      }
    }
  }

  /// Nothing where the key is none, or belongs to many.
  [[nodiscard]] std::string hint(const std::string& key) const {
    if (const auto table = titles_.find(key); table != titles_.end())
      return table->second + " is the table for that";
    if (has(top_, key)) return "'" + key + "' belongs to the top of the file";
    const auto sections = sections_.find(key);
    if (sections == sections_.end() || sections->second.size() > most_sections) return {};
    std::string text;
    for (const std::string& title : sections->second) text += (text.empty() ? "" : ", ") + title;
    return "'" + key + "' belongs to " + text;
  }

  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  [[nodiscard]] bool has_key(const std::string& key) const {
    return sections_.contains(key) || has(top_, key);
  }

 private:
  std::map<std::string, std::string> titles_;
  std::map<std::string, std::vector<std::string>> sections_;
  std::vector<std::string> top_, keys_;
};

std::string hint_elsewhere(const std::string& written, const std::string& word) {
  static const Places places;
  if (places.has_key(written)) return places.hint(written);
  for (const Synonym& synonym : synonyms()) {
    if (!synonym.anywhere || !has(words_of(synonym.words), word)) continue;
    for (const std::string& key : words_of(synonym.keys)) {
      if (std::string hint = places.hint(key); !hint.empty()) return hint;
    }
  }
  return places.hint(closest_word(written, places.keys()));
}

}  // namespace

std::string key_hint(std::string_view word, const std::vector<std::string>& known) {
  const std::string letters = plain(word);
  if (const std::string key = synonym_of(letters, known); !key.empty()) return did_you_mean(key);
  if (std::string text = explanation_of(letters); !text.empty()) return text;
  if (std::string text = suggestion(word, known); !text.empty()) return text;
  return hint_elsewhere(std::string(word), letters);
}

std::string value_hint(std::string_view word, const std::vector<std::string>& allowed) {
  if (const std::string meant = synonym_of(plain(word), allowed); !meant.empty()) return did_you_mean(meant);
  return suggestion(word, allowed);
}

}  // namespace keyblock::scenario
