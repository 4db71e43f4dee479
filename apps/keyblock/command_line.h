#pragma once

namespace keyblock::app {

/// What the process returns to its caller.
enum ExitCode : int {
  done = 0,
  input_wrong = 1,     ///< InputError, or a command line that cannot be read
  run_failed = 2,      ///< RunError; also a run that was interrupted. What was computed so far is kept
  internal_error = 3,  ///< anything else: a mistake in the program
};

/// Does what the command line asks for. Results go to standard output, errors and progress to standard error.
int run_command_line(int argc, const char* const* argv);

}  // namespace keyblock::app
