#include "record/computation_errors.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"
#include "record/energy_warnings.h"

namespace keyblock::record {

namespace {

std::string place_text(const OverlapRecord& place) {
  return fmt::format("{:.1f} mm, block {} at block {}, at {:.2f} s in stage \"{}\"", 1000.0 * place.depth,
                     place.block_a, place.block_b, place.time, place.stage);
}

}  // namespace

std::vector<std::string> computation_errors(const RunRecord& run) {
  std::vector<std::string> errors;
  const ContactChecks& vertices = run.contact_checks;
  if (vertices.across_gaps > 0)
    errors.push_back(fmt::format("contacts pressed across gaps, {} in all steps, the widest gap {}",
                                 vertices.across_gaps, place_text(vertices.farthest)));
  for (std::string& balance : failed_balances(run)) errors.push_back(std::move(balance));
  return errors;
}

void check_computation(const RunRecord& run) {
  const std::vector<std::string> errors = computation_errors(run);
  if (!errors.empty())
    throw RunError("errors of the computation: " + computation_errors_text(errors) +
                   "; the results are kept");
}

std::string computation_errors_text(const std::vector<std::string>& errors) {
  std::string text;
  for (const std::string& error : errors) text += (text.empty() ? "" : "; ") + error;
  return text;
}

}  // namespace keyblock::record
