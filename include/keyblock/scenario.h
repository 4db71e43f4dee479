#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "keyblock/error.h"
#include "keyblock/export.h"

namespace keyblock {

namespace scenario {
struct Override;
}

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

/// A scenario: its text and the values that were put in the place of the text's. docs/scenario.md has the keys. A value type; nothing is
/// checked before check(), cut() or a run, except the syntax.
class KEYBLOCK_API Scenario {
 public:
  /// An empty scenario, to be filled by set().
  Scenario();
  /// Reads a file. Throws InputError when there is none, and when it is no TOML.
  static Scenario load(const std::filesystem::path& file);
  /// From text. `file` stands in messages; paths in the scenario count from its folder.
  static Scenario parse(std::string text, std::filesystem::path file = "scenario.toml");

  /// Puts a value in the place of the text's, as `--set` does: a key path (`rock.young`, `joint_set.J1.dip`, `block[2].outer`) and a
  /// value as TOML has it. What is no TOML value is taken as a string. Tables on the way are made. Throws InputError for a path that is
  /// none, and for elements of lists that do not exist.
  void set(const std::string& key, const std::string& toml);
  /// Adds an element to a list, which is made where there is none. Throws InputError where something else stands there.
  void append(const std::string& key, const std::string& toml);
  /// The value of a key path as JSON, or the whole scenario for an empty path; empty text when the scenario does not say it. Throws
  /// InputError for a path that is none.
  [[nodiscard]] std::string json(const std::string& key = "") const;
  /// The text that was read; of a scenario that began empty, what was set, as TOML.
  [[nodiscard]] std::string text() const;
  /// Whether it began empty: its text is made of what was set.
  [[nodiscard]] bool is_made() const { return is_made_; }
  /// The whole scenario as TOML, with what was set in its place. Comments of the text are lost.
  [[nodiscard]] std::string toml() const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// `key=value` of what was set, in its order, without what was replaced later.
  [[nodiscard]] const std::vector<std::string>& changes() const { return changes_; }

  /// All that `keyblock check` looks at. Returns warnings. Throws one InputError with all mistakes, and RunError where a model cannot be
  /// built.
  [[nodiscard]] std::vector<std::string> check(int realization = 0) const;
  /// The blocks of one realization. Throws InputError, RunError.
  [[nodiscard]] std::vector<Block> cut(int realization = 0) const;

 private:
  struct Document;
  KEYBLOCK_HIDDEN void put(const scenario::Override& override_, std::string change);

  std::shared_ptr<const Document> document_;
  std::string text_;  ///< that was read
  std::filesystem::path file_ = "scenario.toml";
  std::vector<std::string> changes_;
  bool is_made_ = true;
};

}  // namespace keyblock
