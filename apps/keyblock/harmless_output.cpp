#include "harmless_output.h"

#include <string_view>

#include "core/text.h"

namespace keyblock::app {

HarmlessOutput::HarmlessOutput(std::ostream& stream) : stream_(stream), buffer_(stream.rdbuf()) {
  stream_.rdbuf(&buffer_);
}

HarmlessOutput::~HarmlessOutput() {
  stream_.rdbuf(buffer_.target());
}

bool HarmlessOutput::Buffer::put(std::string_view text) {
  const std::string shown = harmless(text);
  return target_->sputn(shown.data(), static_cast<std::streamsize>(shown.size())) ==
         static_cast<std::streamsize>(shown.size());
}

// No character of several bytes is written byte by byte.
HarmlessOutput::Buffer::int_type HarmlessOutput::Buffer::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char byte = traits_type::to_char_type(c);
  return put({&byte, 1}) ? c : traits_type::eof();
}

std::streamsize HarmlessOutput::Buffer::xsputn(const char* text, std::streamsize size) {
  return put({text, static_cast<std::size_t>(size)}) ? size : 0;
}

int HarmlessOutput::Buffer::sync() {
  return target_->pubsync();
}

}  // namespace keyblock::app
