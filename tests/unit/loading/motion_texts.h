#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "loading/motion_file.h"

namespace keyblock::loading {

inline const std::filesystem::path motion_data = std::filesystem::path(KEYBLOCK_TEST_DATA) / "motions";

/// The bytes of a file.
std::string file_content(const std::filesystem::path& path);

/// Reads `text` as a file of its own.
std::vector<MotionComponent> read_text(const std::string& text, const MotionReading& reading = {});

/// The first mistake in reading it. Without any, the test fails.
Diagnostic error_of(const std::string& text, const MotionReading& reading = {});

/// `text` with its first `what` replaced; the test fails when there is none.
std::string replaced(std::string text, const std::string& what, const std::string& by);

/// Small files in the form of those of the networks, with made-up numbers.
std::string at2_text();
/// Acceleration and velocity of one channel, then acceleration of a second one that is positive downwards.
/// Full columns leave no blank between numbers.
std::string cosmos_text();
std::string cosmos_section(const std::string& quantity, int azimuth, const std::string& unit,
                           const std::string& samples);
/// One component of 12 counts; mean 100, scale 0.5 gal.
std::string knet_text(const std::string& direction);
std::string esm_text();
/// Three components of 12 samples: N28W, Up, S62W; with `corrected`, velocity and displacement too.
std::string geonet_text(bool corrected);
std::string afad_text();
/// Three components of 4 samples.
std::string cwa_text();
/// Two channels of 12 samples: 90°, and positive downwards.
std::string usc_text();
/// Two channels of 21 samples: 35°, and upwards.
std::string bhrc_text();
/// Three components of 6 samples: S00E, up, N90W.
std::string unam_text();
/// Volume 1: with a line that begins the samples, or as pairs of time and acceleration.
std::string csmip_1_text(const std::string& title, const std::string& unit_line, const std::string& samples);
std::string csmip_1_pairs();

/// All of these, and the small files of tests/data/motions.
struct NamedText {
  std::string name, text;
};
std::vector<NamedText> motion_corpus();

}  // namespace keyblock::loading
