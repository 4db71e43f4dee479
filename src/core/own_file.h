#pragma once
#include <filesystem>

/// Files that the program keeps in its folders beside results: under temporary names, logs, locks. No link is followed to them, and a
/// file of somebody else that has their name stays as it is.
namespace keyblock {

/// A file that is open for writing.
struct NewFile {
  std::filesystem::path path;
  int descriptor = -1;
};

/// A new file in the folder of `path`, under a name that nothing had: `NAME.PROCESS.tmp` or `NAME.PROCESS.NUMBER.tmp`. Throws RunError.
NewFile create_temporary(const std::filesystem::path& path);

/// Takes away what processes that were killed have left of such files of `path`: those of processes that this machine does not have.
/// For those who hold the lock of the folder, as other machines may write there, too.
void remove_stale_temporaries(const std::filesystem::path& path);

/// A new file of this name, open for writing, in a folder of the program. What had the name goes; a link goes, not what it leads to.
/// Throws RunError.
int create_anew(const std::filesystem::path& path);

/// The names of the files in the folder of `path` outlast a loss of power, as far as the file system promises that.
void sync_folder_of(const std::filesystem::path& path);

}  // namespace keyblock
