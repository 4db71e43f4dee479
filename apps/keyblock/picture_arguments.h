#pragma once
#include <string>

#include "picture/picture.h"

namespace CLI {
class App;
}

namespace keyblock::app {

/// What pictures and films have in common.
struct PictureArguments {
  std::string folder, output;
  picture::Options options;
};

void add_picture_arguments(CLI::App& command, PictureArguments& arguments);

/// The results, of which there must be a frame. Throws InputError.
results::RunData read_frames(const std::string& folder);

}  // namespace keyblock::app
