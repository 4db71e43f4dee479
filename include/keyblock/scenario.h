#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "keyblock/error.h"
#include "keyblock/export.h"
#include "keyblock/value.h"

namespace keyblock {

namespace api {
struct ScenarioAccess;
}

namespace scenario {
struct Override;
struct PathSegment;
struct Value;
}  // namespace scenario

/// What docs/scenario.md says of a key.
struct KeyMeaning {
  std::string key;      ///< within its table: `young`, `spacing.mean`
  std::string meaning;  ///< with its unit
  std::string type;     ///< with range and words
  /// What holds where the key is not given; empty where that is none, or is said in words, as in `standard_text`.
  std::optional<Value> standard;
  std::string standard_text;
};

/// A block as it is cut, before anything moves.
struct Block {
  /// m, real coordinates. The outer ring first, counter-clockwise, then holes, clockwise.
  std::vector<std::vector<std::array<double, 2>>> rings;
  std::string name;                      ///< of an explicit block; empty for cut ones
  std::vector<std::string> excavations;  ///< whose outlines hold the block
  double area = 0.0;                     ///< m²
  /// For the edges of each ring, from point k to point k + 1, what they are pieces of: the name of a joint set, trace map or excavation,
  /// "domain", or empty for an edge of an explicit block.
  std::vector<std::vector<std::string>> edges;
};

/// A block with a face on an opening, or on one that blocks before it have left: docs/guide/limits.md, "Key blocks". Per metre of opening.
struct KeyBlock {
  int block = 0;                      ///< number in Scenario::cut
  std::string name;                   ///< of an explicit block; empty for cut ones
  int layer = 0;                      ///< from 1 on, in which it moves; 0: it stays
  std::array<double, 2> centroid{};   ///< m, real coordinates
  double area = 0.0;                  ///< m²
  double depth = 0.0;                 ///< m, of the corner that is farthest from the wall
  double weight = 0.0;                ///< N/m
  std::string mode;                   ///< falls, slides, slides between faces, stable, not removable
  double factor_of_safety = 0.0;      ///< infinite where nothing drives it
  double force = 0.0;                 ///< N/m against its motion, that it needs for the wanted factor
  std::array<double, 2> direction{};  ///< of its motion, unit vector; zero where nothing drives it
  std::vector<std::string> joints;    ///< sets and maps along which it slides
};

/// The key blocks of one realization.
struct Census {
  std::vector<KeyBlock> blocks;  ///< those that move by layer, then those that stay
  int layers = 0;
  double wall = 0.0;           ///< m, length of the wall of all openings
  double wanted_factor = 0.0;  ///< of safety
  std::string assumptions;     ///< a sentence
};

/// A scenario: its text and the values that were put in the place of the text's. docs/scenario.md has the keys. A value type; nothing is
/// checked before check(), cut() or a run, except the syntax.
class KEYBLOCK_API Scenario {
 public:
  /// An empty scenario, to be filled by set().
  Scenario();
  /// An empty one, paths in which count from the folder of `file`.
  static Scenario empty(std::filesystem::path file);
  /// Reads a file. Throws InputError when there is none, and when it is no TOML.
  static Scenario load(const std::filesystem::path& file);
  /// From text. `file` stands in messages; paths in the scenario count from its folder.
  static Scenario parse(std::string text, std::filesystem::path file = "scenario.toml");

  /// Puts a value in the place of the text's, as `--set` does: a key path (`rock.young`, `joint_set.J1.dip`, `block[2].outer`) and a
  /// value as TOML has it. What is no TOML value is taken as a string. Tables on the way are made. Throws InputError for a path that is
  /// none, and for elements of lists that do not exist.
  void set(const std::string& key, const std::string& toml);
  /// The same of a value at hand, in time and memory proportional to it.
  void set(const std::string& key, const Value& value);
  template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
  void set(const std::string& key, Number value) {
    set(key, Value(value));
  }
  /// Adds an element to a list, which is made where there is none. Throws InputError where something else stands there.
  void append(const std::string& key, const std::string& toml);
  void append(const std::string& key, const Value& value);
  /// Adds several.
  void extend(const std::string& key, const Value::List& values);
  /// Takes a key or an element of a list out. The text is then made of what is left. Throws InputError where there is nothing to take out.
  void remove(const std::string& key);
  /// The value of a key path as JSON, or the whole scenario for an empty path; empty text when the scenario does not say it. Throws
  /// InputError for a path that is none.
  [[nodiscard]] std::string json(const std::string& key = "") const;
  /// The same as a value, or none.
  [[nodiscard]] std::optional<Value> value(const std::string& key = "") const;
  [[nodiscard]] bool has(const std::string& key) const;
  /// Keys of a table in their order; of a list the names of its elements, empty where they have none. Nothing for other values, and for
  /// what the scenario does not say.
  [[nodiscard]] std::optional<std::vector<std::string>> keys(const std::string& key = "") const;
  [[nodiscard]] bool is_table(const std::string& key) const;
  /// Whether a list of tables stands there; or could, as a [[list]] of the scenario that is empty.
  [[nodiscard]] bool is_list_of_tables(const std::string& key) const;
  /// The keys that the program knows of a table of the scenario: `rock`, or `joint_set` for elements of that list; empty for the keys outside all tables.
  [[nodiscard]] static std::vector<KeyMeaning> known_keys(const std::string& table = "");
  /// Throws one InputError with all keys of the path and within the value that the program does not know, each with the nearest that it does.
  /// set() takes them, as check() tells them later; Python asks here first.
  static void check_keys(const std::string& key, const Value& value = {});
  /// The text that was read; of a scenario that began empty, what was set, as TOML.
  [[nodiscard]] std::string text() const;
  /// Whether its text is made of what was set, as it began empty, or something was taken out of it.
  [[nodiscard]] bool is_made() const { return text_ == nullptr; }
  /// The whole scenario as TOML, with what was set in its place. Comments of the text are lost.
  [[nodiscard]] std::string toml() const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// `key=value` of what was set, in its order, without what was replaced later.
  [[nodiscard]] std::vector<std::string> changes() const;

  /// The same as keys and values.
  [[nodiscard]] std::vector<std::pair<std::string, Value>> values_set() const;
  /// Writes toml(). Relative paths of motions and trace maps are rewritten, as they count from the folder of the new file. Throws
  /// InputError and RunError where it cannot be written.
  void save(const std::filesystem::path& file) const;

  /// All that `keyblock check` looks at. Returns warnings. Throws one InputError with all mistakes, and RunError where a model cannot be
  /// built.
  [[nodiscard]] std::vector<std::string> check(int realization = 0) const;
  /// The blocks of one realization. Throws InputError, RunError.
  [[nodiscard]] std::vector<Block> cut(int realization = 0) const;
  /// The key blocks of one realization, with the forces for a wanted factor of safety (≥ 1). Throws InputError, RunError.
  [[nodiscard]] Census census(int realization = 0, double wanted_factor = 1.5) const;

 private:
  struct Document;
  friend struct api::ScenarioAccess;
  KEYBLOCK_HIDDEN Document& own_document();
  KEYBLOCK_HIDDEN void put(const scenario::Override& override_, const std::string& key);
  KEYBLOCK_HIDDEN void add(const std::string& key, std::vector<scenario::Value> elements);
  KEYBLOCK_HIDDEN void note_change(const std::vector<scenario::PathSegment>& path, const std::string& key);

  std::shared_ptr<Document> document_;
  std::shared_ptr<const std::string> text_;  ///< that was read; null: it is made of the document
  std::filesystem::path file_ = "scenario.toml";
};

}  // namespace keyblock
