#include "places.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>

namespace keyblock::fuzz {

namespace fs = std::filesystem;

MemoryFile::MemoryFile() : descriptor_(::memfd_create("fuzz", 0)) {}

MemoryFile::~MemoryFile() {
  ::close(descriptor_);
}

fs::path MemoryFile::hold(std::string_view bytes) {
  const auto size = static_cast<ssize_t>(bytes.size());
  if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, bytes.data(), bytes.size(), 0) != size)
    throw std::runtime_error("no memory for a file");
  return "/proc/self/fd/" + std::to_string(descriptor_);
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "keyblock-fuzz-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void write(const fs::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace keyblock::fuzz
