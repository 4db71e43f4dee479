#pragma once
#include <atomic>

namespace keyblock::app {

/// From now on the first SIGINT, SIGTERM or SIGHUP sets the flag that is returned, and says so; a second one ends the process
/// at once, as it would without this. A SIGHUP that is ignored, as under nohup, stays ignored.
const std::atomic<bool>& stop_on_interrupt();

}  // namespace keyblock::app
