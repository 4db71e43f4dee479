#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/atomic_file.h"

namespace keyblock::results {

struct PythonResult {
  int status = 0;
  std::string output;
};

// Debian's own Python, which sees its packaged modules.
inline PythonResult python(const std::filesystem::path& folder, const std::string& script,
                           const std::string& argument) {
  std::ofstream(folder / "script.py") << script;
  const std::string output = (folder / "output.txt").string();
  const std::string command =
      "/usr/bin/python3 " + (folder / "script.py").string() + " " + argument + " > " + output + " 2>&1";
  const int status = std::system(command.c_str());  // NOLINT(cert-env33-c): the test's own words
  return {status, read_file(output)};
}

inline bool python_has(const std::string& module) {
  const std::string command = "/usr/bin/python3 -c 'import " + module + "' > /dev/null 2>&1";
  return std::system(command.c_str()) == 0;  // NOLINT(cert-env33-c)
}

}  // namespace keyblock::results
