#include "interrupt.h"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace keyblock::app {
namespace {

std::atomic<bool> stop = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch nothing else");

extern "C" void on_signal(int signal) {
  if (stop.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
    return;
  }
  constexpr std::string_view message = "\nstopping; once more ends at once\n";
  static_cast<void>(!::write(STDERR_FILENO, message.data(), message.size()));
}

}  // namespace

const std::atomic<bool>& stop_on_interrupt() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
  struct sigaction before {};
  ::sigaction(SIGHUP, &action, &before);
  if (before.sa_handler == SIG_IGN) ::sigaction(SIGHUP, &before, nullptr);
  return stop;
}

}  // namespace keyblock::app
