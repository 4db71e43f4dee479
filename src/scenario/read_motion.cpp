#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "loading/motion_units.h"
#include "scenario/motion_words.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

constexpr Word<MotionPlace> places[] = {{"outcrop", MotionPlace::outcrop},
                                        {"incident", MotionPlace::incident},
                                        {"within", MotionPlace::within},
                                        {"base", MotionPlace::base},
                                        {"inside", MotionPlace::inside}};

// How a file is read. `given` holds where there is a file to read, `file_condition` says so.
void read_reading(TableReader& t, MotionComponentSpec& component, bool given,
                  std::string_view file_condition) {
  const bool documenting = t.documenting();
  const bool by_hand = t.find("skip") != nullptr || t.find("column") != nullptr || t.find("dt") != nullptr;
  const auto of_file = [&](Rule rule) {
    rule.applies = documenting || given;
    rule.condition = file_condition;
    return rule;
  };
  Rule channel = of_file({.meaning = "Which component of a file that holds several, counted from 1.",
                          .at_least = 1.0,
                          .fallback = "the only one"});
  channel.applies = channel.applies && (documenting || !by_hand);
  channel.condition = "none of skip, column and dt";
  t.integer("channel", component.channel, channel);
  loading::MotionReading& reading = component.reading;
  t.integer(
      "skip", reading.skip,
      of_file({.meaning = "Lines before the numbers. With `skip`, `column` or `dt` the file is read as plain "
                          "numbers, whatever format it has.",
               .at_least = 0.0,
               .fallback = "up to the first line of numbers"}));
  t.integer("column", reading.column,
            of_file({.meaning = "Column of the samples, counted from 1.",
                     .at_least = 1.0,
                     .fallback = "2; with dt all numbers of a line, one after the other"}));
  t.number("dt", reading.dt,
           of_file({.meaning = "Time step between samples.",
                    .unit = "s",
                    .at_least = 1e-9,
                    .at_most = 1e6,
                    .fallback = "times are in column 1",
                    .usual = &usual::step}));
  const bool unit = t.string("unit", reading.unit,
                             of_file({.meaning = "Unit of the samples: \"g\", \"cm/s2\", \"gal\", \"m/s2\", "
                                                 "\"mm/s2\". For a file that names none, and "
                                                 "required with skip, column or dt.",
                                      .fallback = "as the file says"}));
  if (documenting || !given) return;
  if (unit && !loading::acceleration_unit(reading.unit))
    t.fail("unit", fmt::format("the string \"{}\"", reading.unit),
           fmt::format("a unit of acceleration: {}", loading::acceleration_units_text));
  if (by_hand && t.find("unit") == nullptr)
    t.missing("unit", "the unit of the samples, such as \"g\" or \"cm/s2\"");
}

constexpr std::string_view file_meaning =
    "Record. The format is recognized by the content: USGS SMC, CSMIP, COSMOS, PEER AT2, K-NET and KiK-net, "
    "ESM, GeoNet, AFAD, CWA, USC, BHRC, UNAM, or a "
    "table (see the user guide).";

constexpr KeyKind azimuth_kinds[] = {KeyKind::number, KeyKind::string};

void read_component(TableReader& t, MotionComponentSpec& component) {
  component.path = t.path();
  t.file("file", component.file, {.meaning = file_meaning, .required = true});
  read_reading(t, component, true, "");
  const Value* azimuth = t.find("azimuth");
  constexpr std::string_view type = "number from 0 to 360, or \"up\"";
  const Rule rule{
      .meaning = "Direction in which the acceleration is positive: clockwise from north, or upwards.",
      .unit = "°",
      .at_least = 0.0,
      .at_most = 360.0,
      .fallback = "as the file says",
      .kinds = azimuth_kinds};
  if (azimuth != nullptr && azimuth->is_number()) {
    t.number("azimuth", component.azimuth, rule);
  } else if (const Value* found = t.any("azimuth", type, rule); found != nullptr) {
    component.vertical = found->is(Value::Type::string) && found->text == "up";
    if (!component.vertical) t.fail("azimuth", describe(*found), "a number from 0 to 360, or \"up\"");
  }
}

constexpr KeyKind direction_kinds[] = {KeyKind::rows};

// One direction of a motion: rows, a sine or a file. A file becomes a component along the axis.
void read_direction(TableReader& t, std::string_view key, loading::AccelerationTable& rows,
                    std::optional<loading::Sine>& sine, MotionSpec& motion, bool applies) {
  Rule rule{.meaning =
                "Acceleration of the base over time in this direction: rows `[[t, a], …]`, linear between "
                "rows and zero outside, or a sine, or a file.",
            .unit = "s, m/s²",
            .applies = applies,
            .condition = "no components",
            .kinds = direction_kinds,
            .usual = &usual::acceleration};
  const Value* value = t.find(key);
  if (!t.documenting() && (value == nullptr || !value->is(Value::Type::table))) {
    if (t.time_rows(key, rows, true, rule) && rows.front().first < 0.0) {
      t.fail(key, fmt::format("a first time of {}", rows.front().first), "times of at least 0");
    }
    return;
  }
  rule.group = "Sine or file";
  rule.group_meaning =
      "A sine, a(t) = amplitude · sin(2π frequency t), for a number of cycles; or a record of the "
      "acceleration in this direction, "
      "for which no azimuth is needed.";
  t.table(key, rule, [&](TableReader& s) {
    const bool file = s.find("file") != nullptr, documenting = s.documenting();
    const auto of_sine = [&](Rule r) {
      r.required = !file;
      r.applies = !file || documenting;
      r.condition = "no file";
      return r;
    };
    loading::Sine read;
    s.number("amplitude", read.amplitude,
             of_sine({.meaning = "Amplitude of a sine.", .unit = "m/s²", .usual = &usual::acceleration}));
    s.number("frequency", read.frequency,
             of_sine({.meaning = "Its frequency.", .unit = "Hz", .above = 0.0, .usual = &usual::frequency}));
    s.number(
        "cycles", read.cycles,
        of_sine({.meaning = "Number of its cycles, whole or not.", .above = 0.0, .usual = &usual::cycles}));
    MotionComponentSpec component;
    component.path = s.path();
    component.vertical = key == "y";
    component.along_section = key == "x";
    s.file("file", component.file, {.meaning = file_meaning, .fallback = "a sine"});
    read_reading(s, component, file, "a file");
    if (file && !documenting) motion.components.push_back(std::move(component));
    if (!file && !documenting) sine = read;
  });
}

/// A peak that the motion is brought to.
void read_target(TableReader& t, MotionSpec& motion) {
  t.number("pga", motion.pga,
           {.meaning = "Target: the motion is multiplied so that its largest horizontal acceleration in the "
                       "section, within the window, is this. In place of `scale` in the stages.",
            .unit = "m/s²",
            .above = 0.0,
            .fallback = "as recorded",
            .usual = &usual::peak_acceleration});
  t.number("pgv", motion.pgv,
           {.meaning = "Target, likewise: of the largest horizontal velocity in the section, from rest.",
            .unit = "m/s",
            .above = 0.0,
            .fallback = "as recorded",
            .applies = !motion.pga || t.documenting(),
            .condition = "no pga",
            .usual = &usual::peak_velocity});
}

bool has_file(const TableReader& t, std::string_view key) {
  const Value* value = t.find(key);
  return value != nullptr && value->is(Value::Type::table) && value->find("file") != nullptr;
}

}  // namespace

void read_motion(TableReader& t, MotionSpec& motion) {
  motion.path = t.path();
  t.name("name", motion.name, "motion", {.meaning = "Name, for the stages that use it.", .required = true});
  t.word("at", motion.place, places,
         {.meaning =
              "What it is a record of, in the words of SHAKE. `outcrop`: free rock, as most records on "
              "rock are; `incident`: the wave that goes up alone, half of an outcrop (`inside` is an older "
              "word for it); `within`: the ground at `depth`, as an instrument in a borehole sees it; "
              "`base`: the base of the model itself.",
          .fallback = "\"outcrop\" over a compliant base, else \"base\""});
  const bool within = motion.place == MotionPlace::within;
  t.number("depth", motion.depth,
           {.meaning = "Of a record within the ground: below the ground beside the model.",
            .unit = "m",
            .required = within && !t.documenting(),
            .above = 0.0,
            .fallback = "required with at = \"within\"",
            .applies = within || t.documenting(),
            .condition = "at = \"within\"",
            .usual = &usual::depth});
  read_target(t, motion);
  const bool listed = t.find("components") != nullptr;
  const bool record = listed || has_file(t, "x") || has_file(t, "y");
  const bool documenting = t.documenting();
  t.tables("components", motion.components,
           {.meaning = "The components of a record. Horizontal ones are projected on the section: "
                       "a_x = Σ a_i cos(azimuth_i − section azimuth).",
            .condition = "neither x nor y"},
           [](TableReader& c, MotionComponentSpec& component) { read_component(c, component); });
  if (listed && t.find("components")->items.empty())
    t.fail("components", "an empty array", "at least one component");
  t.interval("window", motion.window,
             {.meaning = "Part of the record that is used.",
              .unit = "s",
              .fallback = "the whole record",
              .applies = record || documenting,
              .condition = "components or files"});
  t.word("baseline", motion.baseline, baseline_words,
         {.meaning =
              "What is done to the window: nothing; its mean taken off; a straight line taken off so that "
              "the ground ends at rest where it was; a cosine taper at both ends (5 % each).",
          .applies = record || documenting,
          .condition = "components or files"});
  read_direction(t, "x", motion.x, motion.sine_x, motion, !listed || documenting);
  read_direction(t, "y", motion.y, motion.sine_y, motion, !listed || documenting);
  if (record && !listed && (!motion.x.empty() || !motion.y.empty() || motion.sine_x || motion.sine_y)) {
    const char* other = has_file(t, "x") ? "y" : "x";
    t.fail(other, "rows or a sine beside a file", "a file in both directions, or in one of them only");
  }
  if (!record && t.find("x") == nullptr && t.find("y") == nullptr) {
    t.missing("components", "components of a record, or x or y");
  }
}

}  // namespace keyblock::scenario
