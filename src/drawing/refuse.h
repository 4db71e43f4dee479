#pragma once
#include <string>

namespace keyblock::drawing {

/// Throws the InputError of a place in a file; line 0: of the file as a whole.
[[noreturn]] void refuse(const std::string& file, int line, std::string key, std::string found,
                         std::string expected, std::string hint = {});

}  // namespace keyblock::drawing
