#pragma once
#include <string>

namespace keyblock::app {

/// How this program was built, in lines: version, processor, how many numbers a register holds, compiler.
std::string build_info();

}  // namespace keyblock::app
