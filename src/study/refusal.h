#pragma once
#include <string>

namespace keyblock::study {

/// Throws InputError: in the file or folder `place` (may be empty), this was found where that is expected.
[[noreturn]] void refuse(const std::string& place, const std::string& found, const std::string& expected,
                         const std::string& hint = {});

}  // namespace keyblock::study
