#pragma once
#include <ostream>
#include <streambuf>
#include <string_view>

namespace keyblock::app {

/// While it lives, what is written to a stream reaches its terminal without control characters (core/text.h: harmless), whatever names and
/// titles of scenarios and results hold. Bars that are redrawn do not go through streams.
class HarmlessOutput {
 public:
  explicit HarmlessOutput(std::ostream& stream);
  ~HarmlessOutput();
  HarmlessOutput(const HarmlessOutput&) = delete;
  HarmlessOutput& operator=(const HarmlessOutput&) = delete;

 private:
  class Buffer final : public std::streambuf {
   public:
    explicit Buffer(std::streambuf* target) : target_(target) {}
    [[nodiscard]] std::streambuf* target() const { return target_; }

   protected:
    int_type overflow(int_type c) override;
    std::streamsize xsputn(const char* text, std::streamsize size) override;
    int sync() override;

   private:
    bool put(std::string_view text);
    std::streambuf* target_;
  };

  std::ostream& stream_;
  Buffer buffer_;
};

}  // namespace keyblock::app
