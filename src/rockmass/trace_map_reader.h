#pragma once
#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "rockmass/trace.h"

/// What the readers of trace maps share; for trace_map*.cpp alone.
namespace keyblock::rockmass {

/// What both formats share: the traces found and the mistakes.
class MapReader {
 public:
  MapReader(std::string file, int map_index)
      : file_(std::move(file)), source_{TraceSource::Kind::trace_map, map_index} {}

  void mistake(int line, int column, std::string key, std::string found, std::string expected) {
    if (is_full()) return;
    mistakes_.push_back({{file_, line, column}, std::move(key), std::move(found), std::move(expected), {}});
  }

  /// Whether there are so many mistakes that further ones are not listed.
  [[nodiscard]] bool is_full() const { return mistakes_.size() >= max_mistakes; }

  static constexpr const char* trace_expected = "two or more different vertices";

  /// Adds a trace. Returns what is found in place of one that has no two different vertices.
  std::optional<std::string> add(const std::vector<Vec2>& vertices) {
    const std::size_t before = traces_.size();
    for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
      if (!(vertices[k] == vertices[k + 1]))
        traces_.push_back({vertices[k], vertices[k + 1], source_, polylines_});
    }
    if (traces_.size() == before) {
      return vertices.size() == 1 ? "a trace of one vertex"
                                  : fmt::format("a trace of {} equal vertices", vertices.size());
    }
    ++polylines_;
    return std::nullopt;
  }

  std::vector<Trace> finish() {
    if (mistakes_.empty() && traces_.empty()) mistake(0, 0, "", "no trace", "one trace or more");
    if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
    return std::move(traces_);
  }

 private:
  /// Mistakes beyond this number are not listed.
  static constexpr std::size_t max_mistakes = 20;

  std::string file_;
  TraceSource source_;
  std::vector<Trace> traces_;
  int polylines_ = 0;
  std::vector<Diagnostic> mistakes_;
};

/// Of an offset into the text, counted from 1.
std::pair<int, int> line_and_column(std::string_view text, std::size_t offset);

/// One reader per format; mistakes are added to the map.
void read_geojson(std::string_view text, MapReader& map);
void read_trace_csv(std::string_view text, MapReader& map);

}  // namespace keyblock::rockmass
