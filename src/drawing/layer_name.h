#pragma once
#include <string>
#include <string_view>

namespace keyblock::drawing {

/// A name as it is compared with others: DXF does not tell capitals from small letters.
std::string capitals(std::string_view name);

}  // namespace keyblock::drawing
