#include <CLI/CLI.hpp>

#include "study_commands.h"

namespace keyblock::app {

void add_study_submit(CLI::App& study) {
  static_cast<void>(study);
}

}  // namespace keyblock::app
