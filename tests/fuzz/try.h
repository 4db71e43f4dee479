#pragma once
#include <string>
#include <string_view>

namespace keyblock::fuzz {

/// What each fuzzer has of its own: reads these bytes as what the user may have given. InputError and RunError are right answers; what
/// else is thrown, crashes or takes too long is a find.
void try_bytes(std::string_view bytes);

}  // namespace keyblock::fuzz
