#pragma once
#include <filesystem>

namespace keyblock::app {

/// `keyblock motion --suite`.
struct SuiteArguments {
  std::filesystem::path list, target, spectra;  ///< target and spectra may be empty
  bool force = false, as_json = false;
};
/// Prints a row for each record, and how far the suite is from its target; writes the spectra. Throws InputError.
void show_suite(const SuiteArguments& arguments);

}  // namespace keyblock::app
