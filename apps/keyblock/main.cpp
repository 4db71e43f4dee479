#include "command_line.h"

int main(int argc, char** argv) {
  return keyblock::app::run_command_line(argc, argv);
}
