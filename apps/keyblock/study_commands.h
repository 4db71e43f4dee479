#pragma once
#include <string>

namespace CLI {
class App;
}

namespace keyblock::app {

/// -o DIR; `folder` must outlive the parsing.
void add_study_folder(CLI::App& command, std::string& folder);

/// `study submit`.
void add_study_submit(CLI::App& study);

}  // namespace keyblock::app
