#include "report/frame_codec.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "report/array_pack.h"

namespace keyblock::report {
namespace {

RC_GTEST_PROP(FrameCodec, RestoresNumbersToHalfAQuantum, ()) {
  const auto frames = *rc::gen::inRange<std::size_t>(0, 6);
  const auto columns = *rc::gen::inRange<std::size_t>(0, 9);
  const auto quantum = *rc::gen::element(1e-9, 1e-3, 7.0);
  const auto numbers = *rc::gen::container<std::vector<int>>(frames * columns, rc::gen::arbitrary<int>());
  const auto value = [&](std::size_t f, std::size_t i) {
    return quantum * 0.37 * (numbers[f * columns + i] % 1'000'000);
  };
  const auto bytes = encode_frames(frames, columns, quantum, value);
  RC_ASSERT(bytes.size() == 4 * frames * columns);
  const auto decoded = decode_frames(bytes, frames, columns, quantum);
  for (std::size_t k = 0; k < decoded.size(); ++k)
    RC_ASSERT(std::abs(decoded[k] - value(k / columns, k % columns)) <= 0.5000001 * quantum);
}

TEST(FrameCodec, HoldsWhatCannotBeRepresented) {
  const double values[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity(), 1e30, -1.0};
  const auto bytes = encode_frames(5, 1, 1.0, [&](std::size_t f, std::size_t) { return values[f]; });
  const double bound = 1 << 30;
  EXPECT_EQ(decode_frames(bytes, 5, 1, 1.0), (std::vector<double>{0.0, bound, -bound, bound, -1.0}));
}

TEST(FrameCodec, RestAndCommonMotionAreAllZeros) {
  // Ten vertices: at rest, then moving together by the same step.
  const auto bytes = encode_frames(4, 10, 0.5, [](std::size_t f, std::size_t) { return f < 2 ? 0.0 : 3.0; });
  EXPECT_EQ(std::count_if(bytes.begin(), bytes.end(), [](auto b) { return b != 0; }), 1);
}

TEST(Base64, HasTheVectorsOfRfc4648) {
  const auto encoded = [](std::string_view text) {
    return to_base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xfe\xfd"), "//79");
}

TEST(ArrayPack, AlignsEveryArray) {
  ArrayPack pack;
  pack.add("a", std::vector<std::uint8_t>{1, 2, 3});
  pack.add("b", std::vector<double>{1.0});
  pack.add("c", std::vector<float>{});
  ASSERT_EQ(pack.entries().size(), 3U);
  EXPECT_EQ(pack.entries()[1].offset, 8U);
  EXPECT_EQ(pack.entries()[1].type, "f64");
  EXPECT_EQ(pack.entries()[2].count, 0U);
}

}  // namespace
}  // namespace keyblock::report
