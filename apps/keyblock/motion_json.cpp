#include "motion_json.h"

#include "loading/motion_measures.h"

namespace keyblock::app {

using nlohmann::ordered_json;

ordered_json components_json(const std::vector<loading::MotionComponent>& components) {
  ordered_json list = ordered_json::array();
  for (const loading::MotionComponent& c : components) {
    const loading::MotionMeasures m = loading::measure(c);
    ordered_json json{{"file", c.file},       {"format", c.format}, {"event", c.event},
                      {"station", c.station}, {"label", c.label},   {"vertical", c.vertical}};
    json["azimuth"] = c.azimuth ? ordered_json(*c.azimuth) : ordered_json();
    json["samples"] = c.acceleration.size();
    json["step_s"] = c.times.empty() ? ordered_json(c.dt) : ordered_json();
    json["start_s"] = c.time(0);
    json["duration_s"] = c.duration();
    json["unit"] = c.file_unit;
    json["unit_m_s2"] = c.file_unit_in_si;
    json["peak_m_s2"] = m.peak;
    json["peak_time_s"] = m.peak_time;
    json["peak_velocity_m_s"] = m.peak_velocity;
    json["final_velocity_m_s"] = m.final_velocity;
    json["arias_m_s"] = m.arias_intensity;
    json["significant_duration_s"] = m.significant_duration;
    json["cav_m_s"] = m.absolute_velocity;
    json["processing"] = c.processing;
    json["notes"] = loading::motion_notes(c);
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace keyblock::app
