#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "verification/expression.h"

/// Problems with known answers, as data. The form of a case file: docs/verification.md.
namespace keyblock::verification {

/// An expression and where it stands.
struct Formula {
  Expression expression{0.0};
  SourcePosition where;
  std::string key;
};

/// One row of the table, for every simulation of its run.
struct QuantitySpec {
  std::string name, unit;
  Formula value;
  /// What is known: a figure, one for each order or point of the run, or a bound.
  std::optional<Formula> expected, at_most, at_least;
  std::vector<double> expected_by_order, expected_by_point;
  std::optional<Formula> tolerance;                            ///< relative to what is expected …
  std::optional<Formula> absolute_tolerance;                   ///< … or in the unit of the quantity
  std::optional<double> published;                             ///< figure of a DDA in the literature
  std::vector<double> published_by_order, published_by_point;  ///< NaN: none there
  std::string source;
};

enum class RunCommand { run, cut, census };

/// A set of overrides that is one simulation: key and value as TOML.
using Parameters = std::vector<std::pair<std::string, std::string>>;

struct Point {
  std::string label;  ///< for people, in the place of the parameters; may be empty
  Parameters parameters;
};

struct RunSpec {
  std::string name;
  bool is_long = false;
  std::filesystem::path scenario;  ///< empty for a built-in check
  std::string builtin;
  std::vector<std::filesystem::path> data;  ///< files of a built-in check
  RunCommand command = RunCommand::run;
  std::vector<std::string> set;  ///< key=value
  std::vector<int> orders;       ///< empty: the order of the scenario
  std::vector<std::pair<std::string, std::vector<std::string>>> vary;
  std::vector<Point> points;
  int realizations = 0;  ///< of the rock mass, commands cut and census; 0: the first alone
  long resume_after =
      0;  ///< steps after which the run is interrupted, and gone on with from its checkpoint; 0: never
  std::vector<QuantitySpec> quantities;
};

struct CaseFile {
  std::string name;  ///< of the file, without .toml
  std::string title;
  int number = 0;  ///< in the list of docs/verification.md
  std::string about;
  bool is_long = false;
  std::vector<RunSpec> runs;
};

/// Throws InputError with every mistake of the file.
CaseFile read_case(const std::filesystem::path& file);

/// All *.toml of a folder, ordered by number, then by name. Throws InputError with the mistakes of all files, and when
/// there are none.
std::vector<CaseFile> read_cases(const std::filesystem::path& folder);

}  // namespace keyblock::verification
