#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/folder.h"
#include "core/read_file.h"
#include "core/xml_text.h"
#include "study/limit_search.h"
#include "study/limit_statistics.h"
#include "study/limit_words.h"
#include "study/measures.h"

namespace keyblock::study {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_drawing = 10'000'000;  // bytes
constexpr std::size_t most_drawings = 100;
/// Of the chart, in pixels.
struct Chart {
  static constexpr double width = 720.0, height = 320.0, left = 80.0, right = 20.0, top = 15.0, bottom = 45.0;
};
constexpr double room = 0.05;  // above the largest measure, as a share of their range

constexpr std::string_view page_style = R"(<style>
:root{color-scheme:light dark;--page:#f6f5f2;--paper:#fff;--ink:#1c2126;--muted:#5c656e;--line:#d9d8d3;--accent:#1f5fa8;--bad:#b3261e}
@media (prefers-color-scheme:dark){:root{--page:#16181b;--paper:#1e2125;--ink:#e6e8ea;--muted:#a2abb3;--line:#373c42;--accent:#6fb1f5;--bad:#ff8a80}}
body{font:16px/1.5 system-ui,"Segoe UI","Noto Sans","DejaVu Sans",sans-serif;background:var(--page);color:var(--ink);margin:0 auto;max-width:1300px;padding:16px}
section{background:var(--paper);border:1px solid var(--line);border-radius:8px;padding:12px 16px;margin:16px 0;overflow-x:auto}
a{color:var(--accent)}h1{font-size:1.5em}h2{font-size:1.15em;margin:.3em 0}p.answer{font-size:1.2em}p.how{color:var(--muted)}.warning{border-left:3px solid var(--bad);padding-left:10px}.screen{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,520px),1fr));gap:0 16px;align-items:start}
table{border-collapse:collapse}td,th{padding:3px 12px 3px 0;text-align:right;border-bottom:1px solid var(--line)}th{color:var(--muted);font-weight:normal}
.plot{width:100%;max-width:720px}.plot text{font-size:13px;fill:var(--muted)}.axis{stroke:var(--muted)}.threshold{stroke:var(--muted);stroke-dasharray:5 4}
.line{stroke:var(--accent);stroke-width:2}.bracket{fill:var(--accent);fill-opacity:.18}.no{fill:none;stroke:var(--accent);stroke-width:2}.yes{fill:var(--bad)}
.drawings{display:flex;flex-wrap:wrap;gap:16px}figure{margin:0;width:300px}.one figure{width:min(100%,640px)}figure svg{width:100%;height:auto}td.name{text-align:left}figcaption{font-size:.9em}
</style>)";

std::string paragraph(const char* kind, const std::string& text) {
  if (text.empty()) return {};
  std::string out = fmt::format("<p class=\"{}\">", kind);
  for (const char c : xml_text(text)) out += c == '\n' ? std::string("<br>") : std::string(1, c);
  return out + "</p>";
}

/// The answer, and what was asked.
std::string words(const LimitResult& result) {
  const std::string answer = answer_text(result);
  std::string rest = limit_text(result);
  if (const std::size_t there = rest.find(answer); !answer.empty() && there != std::string::npos)
    rest.erase(there, answer.size());
  return paragraph("answer", answer) + paragraph("how", rest);
}

/// Places of numbers along an axis.
struct Scale {
  double low, high, begin, end;
  [[nodiscard]] double at(double value) const { return begin + (value - low) / (high - low) * (end - begin); }
};

constexpr int ticks = 4;  // parts of an axis

/// "excavation.tunnel.pressure, Pa"
std::string key_title(const LimitResult& result) {
  return result.request.key + (result.unit.empty() ? "" : ", " + result.unit);
}

/// Both axes, with values along that of the key.
std::string frame(const Scale& x, const Scale& y, const LimitResult& result) {
  std::string svg = fmt::format(
      "<path class=\"axis\" fill=\"none\" d=\"M{0:.0f} {1:.0f}V{2:.0f}H{3:.0f}\"/>"
      "<text x=\"{4:.0f}\" y=\"{5:.0f}\" text-anchor=\"middle\">{6}</text>",
      x.begin, y.end, y.begin, x.end, 0.5 * (x.begin + x.end), Chart::height - 8.0,
      xml_text(key_title(result)));
  for (int k = 0; k <= ticks; ++k) {
    const double value = x.low + (x.high - x.low) * k / ticks;
    svg += fmt::format(
        "<path class=\"axis\" d=\"M{0:.2f} {1:.0f}v4\"/><text x=\"{0:.2f}\" y=\"{2:.0f}\" "
        "text-anchor=\"middle\">{3}</text>",
        x.at(value), y.begin, y.begin + 18.0, quantity(value, result.unit, 4));
  }
  return svg;
}

Scale key_scale(const LimitRequest& request) {
  return {std::min(request.from, request.to), std::max(request.from, request.to), Chart::left,
          Chart::width - Chart::right};
}

/// What is drawn of trials over the key.
struct Curve {
  std::string title;  ///< with its unit
  double LimitTrial::*value;
  std::optional<double> threshold;  ///< the same for all trials

  /// What the criterion looks at.
  static Curve of_criterion(const LimitCriterion& criterion) {
    const bool has_threshold = criterion.by_measure && !criterion.above_share;
    return {title_of(criterion.measure), &LimitTrial::measure,
            has_threshold ? std::optional(criterion.above) : std::nullopt};
  }
  static Curve of_moving_area() { return {title_of("moving_area_m2"), &LimitTrial::moving_area, {}}; }

 private:
  static std::string title_of(const std::string& measure) {
    const Measure& m = measures()[find_measure(measure).value()];
    return m.title + (m.unit.empty() ? "" : ", " + m.unit);
  }
};

class Plot {
 public:
  Plot(const LimitResult& result, Curve curve)
      : result_(result),
        request_(result.request),
        curve_(std::move(curve)),
        x_(key_scale(request_)),
        y_{range().first, range().second, Chart::height - Chart::bottom, Chart::top} {}

  [[nodiscard]] std::string draw() const {
    std::string svg = fmt::format(
        "<svg class=\"plot\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{} of every trial over "
        "{}\">",
        Chart::width, Chart::height, xml_text(curve_.title), xml_text(request_.key));
    for (const RealizationLimit& limit : result_.realizations) svg += bracket(limit);
    svg += axes(xml_text(curve_.title));
    for (const RealizationLimit& limit : result_.realizations)
      for (const LimitTrial& trial : limit.trials) svg += point(limit, trial);
    return svg +
           "</svg><p>A dot is a trial at which the criterion is met, a ring one at which it is not; the band "
           "is the "
           "bracket.</p>";
  }

 private:
  /// Of all measures, the threshold and zero.
  [[nodiscard]] std::pair<double, double> range() const {
    const double above = curve_.threshold.value_or(0.0);
    double low = std::min(0.0, above), high = std::max(0.0, above);
    for (const RealizationLimit& limit : result_.realizations) {
      for (const LimitTrial& trial : limit.trials) {
        const double value = trial.*curve_.value;
        if (!std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
    return {low, high > low ? high + room * (high - low) : low + 1.0};
  }

  [[nodiscard]] std::string bracket(const RealizationLimit& limit) const {
    std::string svg;
    for (const Bisection::Bracket& between : limit.state.limits) {
      const double a = x_.at(between.not_met), b = x_.at(between.met);
      svg += fmt::format(
          "<rect class=\"bracket\" x=\"{:.2f}\" y=\"{:.0f}\" width=\"{:.2f}\" height=\"{:.0f}\"/>",
          std::min(a, b), y_.end, std::max(std::abs(a - b), 1.5), y_.begin - y_.end);
    }
    return svg;
  }

  [[nodiscard]] std::string axes(const std::string& title) const {
    std::string svg = frame(x_, y_, result_);
    svg += fmt::format(
        "<text x=\"{0:.0f}\" y=\"{1:.0f}\" text-anchor=\"end\">{6:.3g}</text><text x=\"{0:.0f}\" "
        "y=\"{2:.0f}\" "
        "text-anchor=\"end\">{3:.3g}</text><text transform=\"translate(16 {4:.0f}) rotate(-90)\" "
        "text-anchor=\"middle\">{5}</text>",
        x_.begin - 6.0, y_.begin, y_.end + 5.0, y_.high, 0.5 * (y_.begin + y_.end), title, y_.low);
    if (curve_.threshold)
      svg += fmt::format("<path class=\"threshold\" d=\"M{:.0f} {:.2f}H{:.0f}\"/>", x_.begin,
                         y_.at(*curve_.threshold), x_.end);
    return svg;
  }

  [[nodiscard]] std::string point(const RealizationLimit& limit, const LimitTrial& trial) const {
    const double value = trial.*curve_.value;
    if (!std::isfinite(value)) return {};
    return fmt::format(
        "<circle class=\"{}\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"4\"><title>realization {}: at {}: "
        "{}</title></circle>",
        trial.met ? "yes" : "no", x_.at(trial.value), y_.at(value), limit.realization,
        quantity(trial.value, result_.unit, 6), xml_text(outcome_text(request_, trial)));
  }

  const LimitResult& result_;
  const LimitRequest& request_;
  Curve curve_;
  Scale x_, y_;
};

/// In which share of the realizations the criterion is met, over the key: a staircase in its band.
class SharePlot {
 public:
  explicit SharePlot(const LimitResult& result)
      : result_(result),
        x_(key_scale(result.request)),
        y_{0.0, 1.0, Chart::height - Chart::bottom, Chart::top} {}

  [[nodiscard]] std::string draw() const {
    const std::vector<LimitShare> steps = result_.met_shares();
    if (result_.realizations.size() < 2 || steps.empty()) return {};
    std::string line, up, down;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const double begin = x_.at(steps[k].value),
                   end = x_.at(k + 1 < steps.size() ? steps[k + 1].value : result_.request.to);
      const auto stretch = [&](double share) {
        return fmt::format("{:.2f} {:.2f}L{:.2f} {:.2f}", begin, y_.at(share), end, y_.at(share));
      };
      line += (k == 0 ? "M" : "L") + stretch(steps[k].share.value);
      up += (k == 0 ? "M" : "L") + stretch(steps[k].share.high);
      down.insert(0, fmt::format("L{:.2f} {:.2f}L{:.2f} {:.2f}", end, y_.at(steps[k].share.low), begin,
                                 y_.at(steps[k].share.low)));
    }
    return fmt::format(
               "<section><h2>Realizations in which the criterion is met</h2><svg class=\"plot\" viewBox=\"0 "
               "0 "
               "{:.0f} {:.0f}\" role=\"img\" aria-label=\"Share of realizations over {}\">",
               Chart::width, Chart::height, xml_text(result_.request.key)) +
           fmt::format("<path class=\"bracket\" d=\"{}{}Z\"/><path class=\"line\" fill=\"none\" d=\"{}\"/>",
                       up, down, line) +
           axes() +
           fmt::format(
               "</svg><p>Share of the realizations whose search ended, and its {:.0f} % interval at each "
               "value by "
               "itself (Wilson).</p>{}</section>",
               100.0 * result_.confidence, quantile_table());
  }

 private:
  [[nodiscard]] std::string axes() const {
    std::string svg = frame(x_, y_, result_);
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
      svg += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"end\">{:.0f} %</text>",
                         x_.begin - 6.0, y_.at(share) + 4.0, 100.0 * share);
    return svg;
  }

  [[nodiscard]] std::string quantile_table() const {
    std::string rows;
    const auto cell = [&](const auto& number) {
      const std::string text = result_.number_text(number);
      return fmt::format("<td>{}</td>", text == "?" ? "not known" : text);
    };
    for (const LimitQuantile& quantile : result_.quantiles())
      rows += fmt::format("<tr><td>{:.0f} %</td>{}{}{}</tr>", 100.0 * quantile.p, cell(quantile),
                          cell(quantile.limit.low), cell(quantile.limit.high));
    return fmt::format(
        "<table><tr><th>quantile</th><th>limit of {}</th><th>{:.0f} % interval "
        "from</th><th>to</th></tr>{}</table>"
        "<p>Intervals are by order statistics; an end is not known where there are too few realizations. "
        "Limits beyond an end of the search count as that end; ≥ and ≤ tell where such limits have a part. "
        "<a href=\"limits.csv\">limits.csv</a></p>",
        xml_text(result_.request.key), 100.0 * result_.confidence, rows);
  }

  const LimitResult& result_;
  Scale x_, y_;
};

std::string estimate_cells(const statistics::Estimate& estimate) {
  std::string cells;
  for (const double number : {estimate.value, estimate.low, estimate.high})
    cells += std::isfinite(number) ? fmt::format("<td>{:.4g}</td>", number) : "<td>not known</td>";
  return cells;
}

/// Mean, deviation and, of the factor of safety, the probability that it is below 1; what they hang on.
std::string statistics_section(const LimitResult& result) {
  if (result.realizations.size() < 2) return {};
  const LimitMean mean = mean_limit(result);
  const std::string bound = mean.at_least == mean.at_most ? (mean.at_least ? ", a bound" : "")
                            : mean.at_least               ? ", at least"
                                                          : ", at most";
  std::string rows =
      fmt::format("<tr><td class=\"name\">mean{}</td>{}</tr>", bound, estimate_cells(mean.mean));
  rows += fmt::format("<tr><td class=\"name\">standard deviation</td><td>{:.4g}</td><td></td><td></td></tr>",
                      mean.standard_deviation);
  if (const auto failure = failure_share(result))
    rows += fmt::format("<tr><td class=\"name\">probability that it is below 1 ({} of {})</td>{}</tr>",
                        failure->below, failure->n, estimate_cells(failure->share));
  const std::string head =
      fmt::format("<th>value</th><th>{:.0f} % interval from</th><th>to</th>", 100.0 * result.confidence);
  std::string html = fmt::format(
      "<section><h2>All realizations together</h2><table><tr><th></th>{}</tr>{}</table>", head, rows);
  std::string of_strengths;
  for (const Dependence& one : dependences(result))
    of_strengths +=
        fmt::format("<tr><td class=\"name\">{}</td>{}{}</tr>", xml_text(strength_title(one.strength)),
                    estimate_cells(one.rank_correlation), estimate_cells(one.first_order));
  if (!of_strengths.empty())
    html += fmt::format(
        "<h2>What it hangs on</h2><table><tr><th></th><th>rank correlation</th><th>from</th><th>to</th>"
        "<th>first-order index</th><th>from</th><th>to</th></tr>{}</table><p>Rank correlation (Spearman): −1 "
        "to 1. "
        "First-order index: the share of the variance of the limit that this strength alone explains. Of "
        "strengths that differ from "
        "trace to trace, their mean in each realization.</p>",
        of_strengths);
  return html + "<p><a href=\"statistics.csv\">statistics.csv</a></p></section>";
}

// Link to the report of a run, where it was kept.
std::string link_to(const fs::path& directory, const LimitTrial& trial, const std::string& text) {
  std::error_code none;
  const std::string page = "runs/" + trial.run + "/report.html";
  if (!fs::exists(directory / page, none)) return xml_text(text);
  return fmt::format("<a href=\"{}\">{}</a>", page, xml_text(text));
}

std::string drawing_of(const fs::path& directory, const LimitTrial& trial) {
  const fs::path file = directory / "runs" / trial.run / "thumbnail.svg";
  try {
    return file_exists(file) ? read_own_file(file, largest_drawing) : std::string();
  } catch (const InputError&) {
    return {};
  }
}

std::string drawings(const fs::path& directory, const LimitResult& result) {
  std::string figures;
  std::size_t count = 0;
  for (const RealizationLimit& limit : result.realizations) {
    const LimitTrial* beyond = limit.just_beyond();
    if (beyond == nullptr || count++ >= most_drawings) continue;
    const std::string name =
        fmt::format("realization {}, {} = {}: {}", limit.realization, result.request.key,
                    quantity(beyond->value, result.unit, 6), outcome_text(result.request, *beyond));
    figures += "<figure>" + drawing_of(directory, *beyond) + "<figcaption>" +
               link_to(directory, *beyond, name) + "</figcaption></figure>";
  }
  if (figures.empty()) return {};
  return "<section><h2>Just beyond the limit</h2><div class=\"drawings" +
         std::string(count == 1 ? " one" : "") + "\">" + figures +
         "</div><p>Arrows: how blocks move in the last static stage. Blue: joints beside them that "
         "slip.</p></section>";
}

std::string trial_table(const fs::path& directory, const LimitResult& result) {
  std::string rows;
  for (const RealizationLimit& limit : result.realizations) {
    for (const LimitTrial& trial : limit.trials) {
      rows += fmt::format(
          "<tr><td>{}</td><td>{:.8g}</td><td>{:.5g}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
          limit.realization, trial.value, trial.measure, xml_text(outcome_text(result.request, trial)),
          trial.met ? "yes" : "no", link_to(directory, trial, trial.run));
    }
  }
  return fmt::format(
      "<section><h2>Trials, in the order of the "
      "bisection</h2><table><tr><th>realization</th><th>{}</th><th>{}</th>"
      "<th>at the end</th><th>criterion met</th><th>run</th></tr>{}</table></section>",
      xml_text(key_title(result)), xml_text(result.request.criterion.measure), rows);
}

std::string ground_table(const LimitResult& result) {
  if (result.ground.empty()) return {};
  std::string rows;
  for (const auto& [name, value] : result.ground)
    rows += fmt::format("<tr><td class=\"name\">{}</td><td class=\"name\">{}</td></tr>", xml_text(name),
                        xml_text(value));
  return "<section><h2>Ground and loads</h2><table>" + rows + "</table></section>";
}

std::string warning_list(const LimitResult& result) {
  std::string texts;
  for (const std::string& warning : result.warnings)
    texts += fmt::format("<p class=\"warning\"><b>warning:</b> {}</p>", xml_text(warning));
  return texts;
}

/// Of the factor of safety, how much rock moves at which factor, if that is not the criterion.
std::string moving_area(const LimitResult& result) {
  if (!result.request.is_of_safety() || result.request.criterion.measure == "moving_area_m2") return {};
  return "<section>" + Plot(result, Curve::of_moving_area()).draw() + "</section>";
}

std::string map_section(const LimitResult& result, const HoldMap& map) {
  const std::string svg = hold_map_svg(map, result);
  if (svg.empty()) return {};
  return "<section><h2>Up to which value rock stays in place</h2>" + svg +
         "<p>Of the trials between --from and the first in which a place is loosened, the last. More trials "
         "tell "
         "more levels apart: --sweep or --scan. <a href=\"map.csv\">map.csv</a></p></section>";
}

}  // namespace

std::string limit_page(const fs::path& directory, const LimitResult& result, const HoldMap& map) {
  return fmt::format(
      "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>Limit: "
      "{0}</title>{1}</head><body><h1>{0}</h1><section><h2>Limit of {2}</h2>{3}{12}</section><div "
      "class=\"screen\"><div><section>{4}"
      "</section>{13}{11}</div><div>{5}{14}</div></div>{10}{6}<p>keyblock {7}, {8}, seed {9}; <a "
      "href=\"limit.json\">limit.json</a></p></body></html>\n",
      xml_text(result.title.empty() ? result.scenario : result.title), page_style,
      xml_text(result.request.key), words(result),
      Plot(result, Curve::of_criterion(result.request.criterion)).draw(), drawings(directory, result),
      trial_table(directory, result), xml_text(result.version), xml_text(result.scenario), result.seed,
      SharePlot(result).draw() + statistics_section(result), ground_table(result), warning_list(result),
      moving_area(result), map_section(result, map));
}

}  // namespace keyblock::study
