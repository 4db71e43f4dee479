#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "keyblock/error.h"
#include "keyblock/export.h"
#include "keyblock/simulation.h"

namespace keyblock {

/// A spring, a support or another element, as the model has it.
struct Element {
  std::string name, kind;              ///< as in summary.json: "anchor", "spring"
  double limit = 0.0;                  ///< N per metre thickness, the largest force; infinite: none
  std::array<double, 2> from{}, to{};  ///< m, ends before the run, without the origin
  int from_block = -1, to_block = -1;  ///< that they are points of; −1: of several
};

/// What an element carries at a moment.
struct ElementState {
  std::array<double, 2> from{}, to{};  ///< m, without the origin
  double force =
      0.0;  ///< N per metre thickness; of springs tension is positive, of all else it is the size of the resultant
  double elongation = 0.0;  ///< m, since it was put in; of supports the mean way of what they hold
  double yielded = 0.0;     ///< m of it, that does not come back
  bool present = false;
};

/// One moment of a run.
struct Frame {
  double time = 0.0;  ///< s, simulated
  int stage = 0;
  long step = 0;                                   ///< of the run
  std::vector<std::array<float, 2>> displacement;  ///< m, of every vertex of Results::vertices
  std::vector<std::array<float, 3>> stress;        ///< Pa, mean of every block: xx, yy, xy; tension positive
  std::vector<unsigned char> status;  ///< of every block: 0 in place, 1 loosened, 2 fallen, 3 excavated
  std::vector<std::array<float, 2>> velocity;  ///< m/s, of the mass centre of every block; NaN: not known
  std::vector<ElementState> elements;          ///< of every element of Results::elements
};

/// All contacts at one moment; lengths, forces and names as in a Simulation, positions without the origin.
struct ContactSnapshot {
  double time = 0.0;  ///< s, simulated
  int stage = 0;
  long step = 0;  ///< of the run
  Contacts contacts;
};

/// A chosen point ([[history]]): a value for each of Results::history_times.
struct HistoryOfPoint {
  std::string name;
  std::vector<std::array<double, 2>> displacement;  ///< m, since the start
  std::vector<std::array<double, 2>> velocity;      ///< m/s
  std::vector<std::array<double, 3>> stress;        ///< Pa: xx, yy, xy; tension positive
  std::vector<std::array<double, 2>> acceleration;  ///< m/s², mean over the step before; 0 in static stages
};

/// A history of what an element carries: a value for each of Results::history_times; NaN where it is not there.
struct HistoryOfElement {
  std::string name;
  std::size_t element = 0;  ///< of Results::elements
  std::vector<double> force, elongation;
};

/// A step of which a row was kept.
struct StepEnergies {
  double time = 0.0;  ///< s, simulated
  long step = 0;      ///< of the run
  std::vector<std::pair<std::string, double>>
      energy;  ///< J per metre thickness, by name; residual_ratio without unit
};

/// What a run has left in its folder. Also of a run that goes on or was killed: what is there so far.
class KEYBLOCK_API Results {
 public:
  /// Throws InputError when there are none, or when they are of another format.
  explicit Results(const std::filesystem::path& folder);
  ~Results();
  Results(Results&&) noexcept;
  Results& operator=(Results&&) noexcept;

  [[nodiscard]] std::string summary() const;  ///< as summary.json has it
  [[nodiscard]] std::size_t blocks() const;
  [[nodiscard]] std::size_t frames() const;
  /// Throws std::out_of_range.
  [[nodiscard]] Frame frame(std::size_t k) const;
  [[nodiscard]] std::size_t contact_snapshots() const;
  /// Throws std::out_of_range.
  [[nodiscard]] ContactSnapshot contacts(std::size_t k) const;
  [[nodiscard]] std::vector<double> history_times() const;  ///< s
  [[nodiscard]] std::vector<HistoryOfPoint> histories() const;
  [[nodiscard]] std::vector<HistoryOfElement> element_histories() const;
  [[nodiscard]] std::vector<Element> elements() const;
  [[nodiscard]] std::vector<StepEnergies> energies() const;
  /// Writes them for other programs: "vtk", "csv" or "geojson", in the place of an earlier export; returns the files. `replace`: other
  /// files that are in the way may go. Throws InputError and RunError.
  std::vector<std::filesystem::path> export_to(const std::filesystem::path& folder, const std::string& format,
                                               bool replace = false) const;
  /// m, of all points by which outlines are drawn, before anything moved, without the origin.
  [[nodiscard]] std::vector<std::array<double, 2>> vertices() const;
  /// Of each block, ring by ring: its first vertex, and the first one after it.
  [[nodiscard]] std::vector<std::vector<std::array<int, 2>>> rings() const;
  [[nodiscard]] std::array<double, 2> origin() const;  ///< m, real coordinates of (0, 0)

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace keyblock
