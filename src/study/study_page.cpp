#include "study/study_page.h"

#include <algorithm>
#include <span>

#include "core/checked_json.h"
#include "core/error.h"
#include "core/folder.h"
#include "core/read_file.h"
#include "report/array_pack.h"
#include "report/page_template.h"
#include "report/viewer_template.h"

namespace keyblock::study {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t largest_picture = 10'000'000;  // bytes

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Empty when there is none that can be read.
std::string read_picture(const std::filesystem::path& file) {
  try {
    return file_exists(file) ? read_own_file(file, largest_picture) : std::string();
  } catch (const InputError&) {
    return {};
  }
}

/// Runs in the order in which their pictures are wanted.
std::vector<std::size_t> wanted_pictures(const StudyData& study, const Summary& summary) {
  std::vector<std::size_t> order;
  std::vector<bool> listed(study.runs.size(), false);
  const auto add = [&](std::size_t r) {
    if (!listed[r] && study.runs[r].variant.empty()) order.push_back(r);
    listed[r] = true;
  };
  for (const Combination& c : summary.combinations) {
    if (c.worst) add(*c.worst);
    if (c.median) add(*c.median);
  }
  for (std::size_t r = 0; r < study.runs.size(); ++r) add(r);
  return order;
}

void add_runs(report::ArrayPack& arrays, const StudyData& study, const Summary& summary,
              const std::filesystem::path& directory, std::vector<std::string>& variants) {
  const std::size_t n = study.runs.size();
  std::vector<std::int32_t> realization(n);
  std::vector<std::uint8_t> variant(n), done(n), has_report(n), marginal(n);
  std::vector<float> wall_time(n);
  std::vector<double> values;
  values.reserve(n * measures().size());
  for (std::size_t r = 0; r < n; ++r) {
    const RunResult& run = study.runs[r];
    realization[r] = run.realization;
    const auto name = std::find(variants.begin(), variants.end(), run.variant);
    variant[r] = static_cast<std::uint8_t>(name - variants.begin());
    if (name == variants.end()) variants.push_back(run.variant);
    const auto damage = measured(study, run).damage;
    done[r] = damage ? 1 : 0;
    std::error_code none;
    has_report[r] = std::filesystem::exists(directory / "runs" / run.key / "report.html", none) ? 1 : 0;
    marginal[r] = static_cast<std::uint8_t>(summary.marginal[r]);
    wall_time[r] = static_cast<float>(run.wall_time);
    for (const Measure& m : measures()) values.push_back(damage ? m.of(*damage) : statistics::not_a_number);
  }
  arrays.add("run.realization", realization);
  arrays.add("run.combination",
             std::vector<std::int32_t>(summary.combination_of.begin(), summary.combination_of.end()));
  arrays.add("run.variant", variant);
  arrays.add("run.done", done);
  arrays.add("run.report", has_report);
  arrays.add("run.marginal", marginal);
  arrays.add("run.wall_time", wall_time);
  arrays.add("run.measures", values);
}

void add_pictures(report::ArrayPack& arrays, const StudyData& study, const Summary& summary,
                  const std::filesystem::path& directory) {
  std::vector<std::int32_t> place(study.runs.size(), -1);
  std::vector<std::uint32_t> begin{0};
  std::string pictures;
  for (const std::size_t r : wanted_pictures(study, summary)) {
    if (begin.size() > most_thumbnails) break;
    const std::string svg = read_picture(directory / "runs" / study.runs[r].key / "thumbnail.svg");
    if (svg.empty()) continue;
    place[r] = static_cast<std::int32_t>(begin.size()) - 1;
    pictures += svg;
    begin.push_back(static_cast<std::uint32_t>(pictures.size()));
  }
  arrays.add("run.thumbnail", place);
  arrays.add("thumbnail.begin", begin);
  arrays.add("thumbnail.svg", bytes_of(pictures));
}

}  // namespace

std::string study_page(const std::filesystem::path& directory, const StudyData& study, const Summary& summary,
                       const std::string& study_json) {
  report::ArrayPack arrays;
  std::vector<std::string> variants{""};
  arrays.add("study", bytes_of(study_json));
  add_runs(arrays, study, summary, directory, variants);
  add_pictures(arrays, study, summary, directory);
  ordered_json keys = ordered_json::array(), errors = ordered_json::object();
  for (std::size_t r = 0; r < study.runs.size(); ++r) {
    keys.push_back(study.runs[r].key);
    if (!study.runs[r].error.empty()) errors[std::to_string(r)] = study.runs[r].error;
  }
  const ordered_json texts{{"keys", keys}, {"variants", variants}, {"errors", errors}};
  const std::string text = texts.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  arrays.add("texts", bytes_of(text));

  ordered_json entries = ordered_json::array();
  for (const report::ArrayPack::Entry& e : arrays.entries())
    entries.push_back({{"name", e.name}, {"type", e.type}, {"offset", e.offset}, {"count", e.count}});
  const ordered_json header{
      {"seed", std::to_string(study.seed)}, {"most_thumbnails", most_thumbnails}, {"arrays", entries}};
  return report::fill_page(report::study_template(), study.title.empty() ? "Study" : study.title,
                           report::script_json(header.dump()), arrays.encoded());
}

}  // namespace keyblock::study
