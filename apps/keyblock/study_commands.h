#pragma once
#include <string>

#include "study/collect.h"

namespace CLI {
class App;
}

namespace keyblock::app {

/// -o DIR; `folder` must outlive the parsing.
void add_study_folder(CLI::App& command, std::string& folder);

/// `study submit`.
void add_study_submit(CLI::App& study);

/// `study status`.
void add_study_status(CLI::App& study);

/// Names runs that are not done, and ends with `N of M runs done, …`, without the end of the line.
void print_count(const study::StudyCount& count);

}  // namespace keyblock::app
