#pragma once
#include <filesystem>
#include <string_view>

#include "core/read_file.h"

namespace keyblock {

/// A file that is written piece by piece under a temporary name beside `path`, and renamed when it is complete, so that no
/// reader ever sees half a file. Every member throws RunError when the disk is full or the folder cannot be written;
/// `path` is then as it was before, as it is when the object goes before `commit`.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  /// No more is written. May be left out before `publish` and `commit`.
  void close();
  /// Gives the file its name. A link of that name is replaced, not followed.
  void publish();
  /// The same; the name outlasts a loss of power.
  void commit();

 private:
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_, temporary_;
  int descriptor_ = -1;
  bool committed_ = false;
};

/// AtomicFile of a content that is there already.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace keyblock
