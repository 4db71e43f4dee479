#include "results/export_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/checked_json.h"
#include "core/error.h"
#include "core/folder.h"

namespace keyblock::results {
namespace {

namespace fs = std::filesystem;

constexpr const char* list_name = "keyblock-export.json";

[[noreturn]] void refuse_to_replace(const fs::path& place, std::string found, std::string expected) {
  Diagnostic diagnostic;
  diagnostic.where.file = place.string();
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  throw InputError(std::move(diagnostic));
}

constexpr std::pair<std::string_view, std::string_view> endings[] = {
    {"vtk", ".vtu"}, {"vtk", ".vtp"}, {"vtk", ".pvd"},
    {"vtk", ".py"},  {"csv", ".csv"}, {"geojson", ".geojson"}};

// Of a list that somebody has changed, only names of files in this very folder that an export of this format writes.
bool is_exported(const std::string& format, const std::string& name) {
  const fs::path path(name);
  if (path.filename() != name || path.stem().empty()) return false;
  return std::find(std::begin(endings), std::end(endings),
                   std::pair<std::string_view, std::string_view>(format, path.extension().string())) !=
         std::end(endings);
}

// Empty where there is no list, or none that can be read.
std::map<std::string, std::set<std::string>> read_list(const fs::path& folder) {
  std::map<std::string, std::set<std::string>> names;
  if (!file_exists(folder / list_name)) return names;
  const auto json = nlohmann::json::parse(read_own_file(folder / list_name), nullptr, false);
  if (!json.is_object()) return names;
  for (const auto& [format, files] : json.items()) {
    for (const auto& file : files) {
      if (file.is_string() && is_exported(format, file.get<std::string>()))
        names[format].insert(file.get<std::string>());
    }
  }
  return names;
}

std::string list_text(const std::map<std::string, std::set<std::string>>& names) {
  return nlohmann::json(names).dump(1) + "\n";
}

}  // namespace

ExportFolder::ExportFolder(fs::path folder, std::string format, bool replace)
    : folder_(std::move(folder)),
      format_(std::move(format)),
      replace_(replace),
      files_(folder_),
      exported_(read_list(folder_)) {
  if (!replace_ && exported_.empty()) check_is_for_exports();
}

// What an export that was killed has left under temporary names does not count.
void ExportFolder::check_is_for_exports() const {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    if (entry.path().extension() == ".tmp") continue;
    refuse_to_replace(folder_, fmt::format("{}, which is of no export", entry.path().filename().string()),
                      "a new or an empty folder, one of an earlier export, or --force");
  }
}

void ExportFolder::check_replaces_only_exports(const std::vector<fs::path>& written) const {
  for (const fs::path& path : written) {
    const std::string name = path.filename().string();
    const bool known = std::any_of(exported_.begin(), exported_.end(),
                                   [&](const auto& entry) { return entry.second.contains(name); });
    if (!known && file_exists(path))
      refuse_to_replace(path, "a file that is of no export", "another folder, or --force to replace it");
  }
}

void ExportFolder::commit(const std::vector<fs::path>& written) {
  if (!replace_) check_replaces_only_exports(written);
  std::set<std::string> names, outdated;
  for (const fs::path& path : written) names.insert(path.filename().string());
  std::set<std::string>& listed = exported_[format_];
  std::set_difference(listed.begin(), listed.end(), names.begin(), names.end(),
                      std::inserter(outdated, outdated.end()));
  // At every moment the list names all that is there.
  listed.insert(names.begin(), names.end());
  write_file_atomically(folder_ / list_name, list_text(exported_));
  files_.commit();
  if (outdated.empty()) return;
  for (const std::string& name : outdated) {
    std::error_code error;
    fs::remove(folder_ / name, error);
    if (error)
      throw RunError(fmt::format("{}: cannot remove: {}", (folder_ / name).string(), error.message()));
  }
  listed = names;
  write_file_atomically(folder_ / list_name, list_text(exported_));
}

}  // namespace keyblock::results
