#include "scenario/element_histories.h"

#include <algorithm>

#include "core/error.h"
#include "scenario/key_path.h"
#include "simulation/build_model.h"
#include "simulation/elements.h"

namespace keyblock::scenario {

void check_element_histories(const Scenario& scenario, const simulation::RunSetup& setup) {
  const auto of_element = [](const simulation::History& history) { return !history.element.empty(); };
  if (std::ranges::none_of(setup.histories, of_element)) return;
  // Which elements there are, only couplings know.
  const dynamics::Model model = simulation::build_model(setup);
  std::vector<std::string> names;
  for (const auto& element : simulation::element_descriptions(model)) names.push_back(element.name);
  for (const simulation::History& history : setup.histories) {
    if (!of_element(history)) continue;
    try {
      simulation::element_of(model, history);
    } catch (const InputError& error) {
      Diagnostic diagnostic = error.diagnostics().front();
      diagnostic.where = scenario.where(diagnostic.key);
      diagnostic.hint = suggestion(history.element, names);
      throw InputError(std::move(diagnostic));
    }
  }
}

}  // namespace keyblock::scenario
