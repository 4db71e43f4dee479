#pragma once
#include <cmath>
#include <span>
#include <string>
#include <string_view>

/// What quantities of rock engineering usually are, in SI units. A key names its quantity in its Rule, and a value far from it is told, with
/// the unit in which it was probably meant. Zero is meant.
namespace keyblock::scenario {

/// A unit in which a value may be given by mistake, and what it is in the right one.
struct OtherUnit {
  std::string_view name;
  double factor;
};

/// What a quantity usually is, in its unit, of either sign. A mistaken unit is named where it brings the value within `likely`.
struct Usual {
  std::string_view unit;
  double least, most;
  double least_likely, most_likely;
  std::span<const OtherUnit> mistaken{};
  bool may_be_tangent = false;  ///< an angle that may be given as a coefficient
  /// From here on a value is meant: it says that a limit is never reached.
  double without_limit = HUGE_VAL;
};

/// A value of a scenario that its quantity usually has not.
struct UnusualValue {
  std::string key;   ///< its path
  std::string text;  ///< the warning
};

/// "usual is 1000 to 4000 kg/m3; was it in t/m3 or g/cm3? That is 2600 kg/m3"; empty where the value is usual.
std::string unusual_text(const Usual& usual, double value);
/// "2600 kg/m3".
std::string with_unit(double value, std::string_view unit);

namespace usual {

inline constexpr double standard_weight = 9.81;
inline constexpr OtherUnit densities[] = {{"t/m3 or g/cm3", 1e3},
                                          {"kN/m3, a weight", 1e3 / standard_weight},
                                          {"N/m3, a weight", 1.0 / standard_weight},
                                          {"lb/ft3", 16.0185},
                                          {"g/m3", 1e-3}};
inline constexpr OtherUnit pressures[] = {{"GPa", 1e9}, {"MPa", 1e6}, {"kPa", 1e3}, {"mPa", 1e-3}};
inline constexpr OtherUnit stiffnesses[] = {{"GPa/m", 1e9}, {"MPa/m", 1e6}, {"kPa/m", 1e3}};
inline constexpr OtherUnit strengths[] = {{"MPa", 1e6}, {"kPa", 1e3}, {"mPa", 1e-3}};
inline constexpr OtherUnit accelerations[] = {{"g", standard_weight}, {"cm/s2", 1e-2}, {"mm/s2", 1e-3}};
inline constexpr OtherUnit percents[] = {{"percent", 1e-2}};
inline constexpr OtherUnit speeds[] = {{"km/s", 1e3}};
inline constexpr OtherUnit slow_speeds[] = {{"cm/s", 1e-2}, {"mm/s", 1e-3}};
inline constexpr OtherUnit forces[] = {{"kN/m", 1e3}, {"MN/m", 1e6}};
inline constexpr OtherUnit spring_stiffnesses[] = {{"kN/m per m", 1e3}, {"MN/m per m", 1e6}};
inline constexpr OtherUnit bolt_forces[] = {{"kN", 1e3}, {"MN", 1e6}};
inline constexpr OtherUnit dowel_stiffnesses[] = {{"kN/m", 1e3}, {"MN/m", 1e6}};
inline constexpr OtherUnit grout_stiffnesses[] = {{"kN/m per m", 1e3}, {"MN/m per m", 1e6}};
inline constexpr OtherUnit grout_strengths[] = {{"kN per m", 1e3}, {"MN per m", 1e6}};
inline constexpr OtherUnit lengths[] = {{"cm", 1e-2}, {"mm", 1e-3}, {"km", 1e3}};
inline constexpr OtherUnit times[] = {{"ms", 1e-3}};
inline constexpr OtherUnit frequencies[] = {{"kHz", 1e3}, {"mHz", 1e-3}};

inline constexpr Usual density{"kg/m3", 1e3, 4e3, 1.5e3, 3.5e3, densities};
inline constexpr Usual water_density{"kg/m3", 500.0, 2e3, 9e2, 1.3e3, densities};
inline constexpr Usual young{"Pa", 5e7, 1e12, 1e8, 2e11, pressures};
inline constexpr Usual poisson{"", 0.01, 0.5, 0.1, 0.45};
inline constexpr Usual stiffness{"Pa/m", 1e6, 1e14, 1e8, 1e13, stiffnesses};
/// Of joints. Intact rock has a cohesion of some 50 MPa at the most.
inline constexpr Usual strength{"Pa", 1e2, 5e7, 1e3, 2e7, strengths, false, 1e9};
inline constexpr Usual stress{"Pa", 1e2, 1e9, 5e4, 2e8, strengths};
inline constexpr Usual friction{"degrees", 5.0, 75.0, 10.0, 60.0, {}, true};
inline constexpr Usual angle{"degrees", 0.1, 720.0, 1.0, 360.0};
inline constexpr Usual scatter{"degrees", 0.1, 60.0, 1.0, 30.0};
inline constexpr Usual stress_ratio{"", 0.05, 5.0, 0.2, 4.0, percents};
inline constexpr Usual depth{"m", 1.0, 1e4, 5.0, 5e3, lengths};
inline constexpr Usual weight{"m/s2", 1.0, 30.0, 5.0, 15.0, accelerations};
inline constexpr Usual speed{"m/s", 50.0, 9e3, 150.0, 8e3, speeds};
inline constexpr Usual wall_pressure{"Pa", 1e3, 2e7, 5e3, 5e6, strengths};
/// Of springs and of points of supports: what holds a block in its place may be as stiff as anybody likes.
inline constexpr Usual spring_stiffness{"N/m per m", 1e4, HUGE_VAL, 1e5, 1e11, spring_stiffnesses};
inline constexpr Usual bed_stiffness{"Pa/m", 1e5, HUGE_VAL, 1e6, 1e13, stiffnesses};
inline constexpr Usual yield{"N/m", 1e3, 1e8, 5e3, 2e7, forces};
/// Of one bolt.
inline constexpr Usual bolt_force{"N", 1e3, 1e7, 5e3, 5e6, bolt_forces};
inline constexpr Usual bolt_spacing{"m", 0.2, 50.0, 0.3, 10.0, lengths};
inline constexpr Usual bar_diameter{"m", 0.004, 0.12, 0.01, 0.06, lengths};
inline constexpr Usual bar_young{"Pa", 5e9, 4e11, 3e10, 2.2e11, pressures};
inline constexpr Usual rupture_strain{"", 0.002, 0.5, 0.005, 0.3, percents};
inline constexpr Usual dowel_stiffness{"N/m", 1e5, HUGE_VAL, 1e6, 1e10, dowel_stiffnesses};
inline constexpr Usual grout_stiffness{"N/m per m", 1e7, 1e12, 1e8, 1e11, grout_stiffnesses};
inline constexpr Usual grout_strength{"N per m", 5e3, 1e7, 1e4, 5e6, grout_strengths};
inline constexpr Usual liner_thickness{"m", 0.01, 3.0, 0.03, 1.0, lengths};
inline constexpr Usual liner_young{"Pa", 1e8, 2.5e11, 2e9, 6e10, pressures};
inline constexpr Usual compressive_strength{"Pa", 1e6, 4e8, 5e6, 1e8, strengths};
inline constexpr Usual force{"N/m", 1.0, 1e7, 1e3, 5e6, forces};
inline constexpr Usual traction{"Pa", 1e2, 1e9, 1e3, 1e8, strengths};
inline constexpr Usual extent{"m", 0.05, 1e4, 1.0, 3e3, lengths};
inline constexpr Usual spacing{"m", 0.005, 1e3, 0.05, 50.0, lengths};
inline constexpr Usual opening{"m", 0.05, 2e2, 1.0, 50.0, lengths};
inline constexpr Usual way{"m", 1e-5, 1e2, 1e-3, 5.0, lengths};
inline constexpr Usual small_way{"m", 1e-6, 10.0, 1e-5, 2.0, lengths};
inline constexpr Usual weakening{"m", 1e-7, 0.5, 1e-6, 0.3, lengths};
inline constexpr Usual step{"s", 1e-5, 0.1, 1e-4, 0.05, times};
inline constexpr Usual duration{"s", 0.02, 600.0, 0.1, 300.0, times};
inline constexpr Usual interval{"s", 2e-4, 60.0, 1e-3, 10.0, times};
inline constexpr Usual frequency{"Hz", 0.05, 300.0, 0.2, 100.0, frequencies};
inline constexpr Usual cycles{"", 0.25, 500.0, 1.0, 100.0};
inline constexpr Usual acceleration{"m/s2", 0.01, 50.0, 0.1, 30.0, accelerations};
/// Of a target, which few give for weak shaking: 0.1 to 0.5 is meant in g.
inline constexpr Usual peak_acceleration{"m/s2", 0.5, 30.0, 0.4, 20.0, accelerations};
/// Of a sine or table: weaker ones than 0.15 are meant, as for waves, and stronger ones may be in m/s2.
inline constexpr Usual shaking{"m/s2", 0.5, 30.0, 1.5, 20.0, accelerations};
inline constexpr Usual peak_velocity{"m/s", 0.003, 5.0, 0.01, 3.0, slow_speeds};
inline constexpr Usual block_velocity{"m/s", 1e-4, 100.0, 1e-2, 50.0, slow_speeds};
inline constexpr Usual factor{"", 0.01, 100.0, 0.1, 10.0, percents};
inline constexpr Usual load_factor{"", 0.02, 20.0, 0.1, 10.0, percents};
inline constexpr Usual strength_factor{"", 0.05, 50.0, 0.5, 10.0, percents};
inline constexpr Usual coefficient{"", 0.001, 2.0, 0.01, 1.0, percents};
inline constexpr Usual damping{"", 1e-4, 1.0, 0.002, 0.5, percents};

}  // namespace usual

}  // namespace keyblock::scenario
