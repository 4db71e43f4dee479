#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "keyblock/error.h"
#include "keyblock/export.h"

namespace keyblock {

/// One moment of a run.
struct Frame {
  double time = 0.0;  ///< s, simulated
  int stage = 0;
  long step = 0;                                   ///< of the run
  std::vector<std::array<float, 2>> displacement;  ///< m, of every vertex of Results::vertices
  std::vector<std::array<float, 3>> stress;        ///< Pa, mean of every block: xx, yy, xy; tension positive
  std::vector<unsigned char> status;  ///< of every block: 0 in place, 1 loosened, 2 fallen, 3 excavated
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
