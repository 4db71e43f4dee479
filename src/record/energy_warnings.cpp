#include "record/energy_warnings.h"

#include <fmt/format.h>

namespace keyblock::record {

namespace {

std::string missed(const Energy& energy) {
  return fmt::format("the balance of energies misses {:.3g} % of its largest term",
                     100.0 * energy.residual_ratio);
}

/// Also where the ratio is no number.
bool has_failed(const Energy& energy) {
  return !(energy.residual_ratio <= failed_residual);
}

std::string reason_of_failure(const Energy& energy) {
  return fmt::format(
      "{}, more than {:.0f} %: forces and motion do not belong together, and the results are not to be used; "
      "a "
      "smaller time.step may help",
      missed(energy), 100.0 * failed_residual);
}

bool has_made_most(const RunRecord& run) {
  return run.made.share() > failed_made;
}

std::string made(const RunRecord& run) {
  return fmt::format(
      "the rule of time integration has made energy, {:.3g} % of the largest term that is accounted for at "
      "{:.3g} s",
      100.0 * run.made.ratio, run.made.time);
}

std::string made_too_much(const RunRecord& run) {
  return fmt::format(
      "{}, more than {:.0f} %: what moves has it from nothing, and the results are not to be used; "
      "another solver.integrator, or a smaller time.step, may help",
      made(run), 100.0 * failed_made);
}

}  // namespace

std::vector<std::string> energy_warnings(const RunRecord& run) {
  std::vector<std::string> texts;
  if (has_failed(run.energy)) {
    texts.push_back(reason_of_failure(run.energy));
  } else if (run.energy.residual_ratio > doubtful_residual) {
    texts.push_back(fmt::format("{}, more than {:.0f} %: compare with a run with a smaller time.step",
                                missed(run.energy), 100.0 * doubtful_residual));
  }
  if (has_made_most(run)) {
    texts.push_back(made_too_much(run));
  } else if (run.made.ratio > doubtful_made) {
    texts.push_back(made(run) +
                    ": compare with a run with a smaller time.step, or with another solver.integrator");
  }
  return texts;
}

std::vector<std::string> failed_balances(const RunRecord& run) {
  std::vector<std::string> texts;
  if (run.interrupted) return texts;
  if (has_failed(run.energy)) texts.push_back(reason_of_failure(run.energy));
  if (has_made_most(run)) texts.push_back(made_too_much(run));
  return texts;
}

}  // namespace keyblock::record
