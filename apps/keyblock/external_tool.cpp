#include "external_tool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "core/error.h"
#include "core/read_file.h"

namespace keyblock::app {
namespace {

namespace fs = std::filesystem;

std::string last_words(const fs::path& file) {
  constexpr std::size_t most = 600;
  std::string text = read_file(file);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.size() > most ? text.substr(text.size() - most) : text;
}

}  // namespace

fs::path find_tool(const ExternalTool& tool) {
  const char* variable = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): nothing sets it
  std::string_view rest = variable == nullptr ? "" : variable;
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    const fs::path file = fs::path(folder) / tool.name;
    if (!folder.empty() && ::access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file)) return file;
  }
  Diagnostic diagnostic;
  diagnostic.found = fmt::format("no program {} on the PATH", tool.name);
  diagnostic.expected = fmt::format("{}, as {}", tool.name, tool.purpose);
  diagnostic.hint = fmt::format("apt-get install {}; {}", tool.package, tool.without);
  throw InputError(std::move(diagnostic));
}

void run_tool(const fs::path& tool, const std::vector<std::string>& arguments) {
  const WorkFolder folder(fs::temp_directory_path() / "keyblock-tool");
  const fs::path log = folder / "log";
  std::vector<std::string> words{tool.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0600);
  ::posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  pid_t id = 0;
  const int failed = ::posix_spawn(&id, words[0].c_str(), &files, nullptr, pointers.data(), ::environ);
  ::posix_spawn_file_actions_destroy(&files);
  if (failed != 0)
    throw RunError(fmt::format("{} could not be started: {}", words[0], std::strerror(failed)));
  int status = 0;
  while (::waitpid(id, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const std::string said = last_words(log);
  const bool knows_no_svg = said.find("codec svg") != std::string::npos;
  throw RunError(
      fmt::format("{} has failed: {}{}", words[0], said,
                  knows_no_svg ? "; it was built without librsvg, that of Debian was built with it" : ""));
}

WorkFolder::WorkFolder(const fs::path& path) {
  std::string name = path.string() + ".XXXXXX";
  if (::mkdtemp(name.data()) == nullptr)
    throw RunError(fmt::format("{}: no folder can be made: {}", name, std::strerror(errno)));
  folder_ = name;
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace keyblock::app
