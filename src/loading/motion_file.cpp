#include "loading/motion_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "loading/motion_formats.h"

namespace keyblock::loading {

std::size_t MotionComponent::peak_index() const {
  std::size_t peak = 0;
  for (std::size_t k = 1; k < acceleration.size(); ++k) {
    if (std::abs(acceleration[k]) > std::abs(acceleration[peak])) peak = k;
  }
  return peak;
}

namespace {

// A new format has its line here; the order is that in which they are tried.
constexpr const MotionFormat* formats[] = {
    &smc_format,  &usc_format, &csmip_format, &cosmos_format, &knet_format, &esm_format,     &geonet_format,
    &afad_format, &cwa_format, &bhrc_format,  &unam_format,   &at2_format,  &counted_format, &table_format};

// m/s². What is summed and squared of larger ones would not stay finite.
constexpr double largest_acceleration = 1e9;

constexpr std::size_t longest_line = 1'000'000;

void check_samples(const std::vector<MotionComponent>& components) {
  for (const MotionComponent& component : components) {
    const std::size_t peak = component.peak_index();
    if (std::abs(component.acceleration[peak]) <= largest_acceleration) continue;
    refuse_file(
        component.file,
        fmt::format("an acceleration of {:.3g} {} in sample {}",
                    component.acceleration[peak] / component.file_unit_in_si, component.file_unit, peak + 1),
        fmt::format("at most {:.0e} m/s2", largest_acceleration));
  }
}

void check_lines(const std::string& file, std::string_view content) {
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find_first_of("\r\n", begin), content.size());
    if (end - begin > longest_line)
      refuse_file(file, fmt::format("a line of {} characters", end - begin),
                  fmt::format("lines of at most {} characters", longest_line));
    begin = end + 1;
  }
}

void check_is_text(const std::string& file, std::string_view content) {
  const std::pair<std::string_view, const char*> known[] = {
      {"PK\x03\x04", "a zip archive or a spreadsheet; unpack it, or save the sheet as CSV"},
      {"\x1F\x8B", "compressed by gzip; unpack it"},
      {"\x89HDF", "HDF5; write the samples as a table of text"},
      {"%PDF", "a PDF"},
      {"\xFF\xFE", "UTF-16; save it as UTF-8"},
      {"\xFE\xFF", "UTF-16; save it as UTF-8"}};
  for (const auto& [magic, meaning] : known) {
    if (content.starts_with(magic)) refuse_file(file, "a file that is no plain text", "a text file", meaning);
  }
  constexpr std::size_t looked_at = 1 << 16;
  const std::string_view head = content.substr(0, looked_at);
  if (head.find('\0') == std::string_view::npos) return check_lines(file, content);
  const bool sequence = head.size() > 8 &&
                        head.substr(0, 6).find_first_not_of("0123456789 ") == std::string_view::npos &&
                        std::string_view("DRQM").find(head[6]) != std::string_view::npos;
  refuse_file(file, "a binary file", "a text file",
              sequence ? "it seems to be miniSEED; write the samples as a table of text" : "");
}

void check_unit(const MotionText& text, const MotionReading& reading,
                const std::vector<MotionComponent>& components) {
  const auto stated = stated_unit(text, reading);
  if (!stated) return;
  for (const MotionComponent& component : components) {
    if (component.file_unit_in_si == stated->in_si) continue;
    text.refuse(fmt::format("unit = \"{}\", and {} in the file", reading.unit, component.file_unit),
                "the unit of the file");
  }
}

}  // namespace

std::string motion_format_names() {
  std::string names;
  for (const MotionFormat* format : formats) {
    if (format == &table_format || format == &counted_format) continue;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", format->name);
  }
  return names + " or a table";
}

std::vector<MotionComponent> read_motion_file(const std::filesystem::path& path,
                                              const MotionReading& reading) {
  std::string content = read_file(path);
  check_is_text(path.string(), content);
  const MotionText text(path.string(), std::move(content));
  std::vector<MotionComponent> components;
  if (reading.by_hand()) {
    components = read_by_hand(text, reading);
  } else {
    const auto* const format = std::find_if(std::begin(formats), std::end(formats),
                                            [&](const MotionFormat* f) { return f->matches(text); });
    if (format == std::end(formats)) {
      text.fail(0, 1, text.size() == 0 ? "the end of the file" : quoted_text(text.line(0)),
                fmt::format("a record in the format {} (time, accelerations)", motion_format_names()),
                "any other text is read with skip, column, dt and unit");
    }
    components = (*format)->read(text, reading);
  }
  check_unit(text, reading, components);
  check_samples(components);
  return components;
}

}  // namespace keyblock::loading
