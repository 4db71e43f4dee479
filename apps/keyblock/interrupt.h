#pragma once
#include <atomic>

namespace keyblock::app {

/// From now on the first SIGINT or SIGTERM sets the flag that is returned, and says so; a second one ends the process
/// at once, as it would without this.
const std::atomic<bool>& stop_on_interrupt();

}  // namespace keyblock::app
