#pragma once
#include <string_view>

namespace keyblock::report {

/// The pages as built from viewer/ (embedded at build time), with three places to fill, each exactly once:
/// `@@title@@` (HTML text), `@@header@@` (JSON inside a script element), `@@arrays@@` (base64).
std::string_view viewer_template();  ///< of the report of a run
std::string_view study_template();   ///< of the report of a study

}  // namespace keyblock::report
