#include "core/text.h"

#include <gtest/gtest.h>

#include "core/xml_text.h"

namespace keyblock {
namespace {

TEST(Utf8, LengthsOfCharacters) {
  EXPECT_EQ(utf8_length("a", 0), 1U);
  EXPECT_EQ(utf8_length("xü", 1), 2U);
  EXPECT_EQ(utf8_length("€", 0), 3U);
  EXPECT_EQ(utf8_length("\xF0\x9F\xAA\xA8", 0), 4U);
}

TEST(Utf8, WhatIsNone) {
  for (const char* text : {"\xFC", "\xC3", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80",
                           "\x80", "\xE2\x82", "\xF5\x80\x80\x80"}) {
    EXPECT_EQ(utf8_length(text, 0), 0U) << printable(text, 10);
  }
  EXPECT_EQ(find_invalid_utf8("Grün"), std::string_view::npos);
  EXPECT_EQ(find_invalid_utf8("Gr\xFCn"), 2U);
}

TEST(Printable, EscapesWhatATerminalWouldObey) {
  EXPECT_EQ(printable("Grün, 3 m", 20), "Grün, 3 m");
  EXPECT_EQ(printable("a\nb\tc\rd", 20), "a\\nb\\tc\\rd");
  EXPECT_EQ(printable("\x1b[2J\x7f\xFC", 20), "\\x1b[2J\\x7f\\xfc");
}

TEST(Printable, EscapesControlCharactersOfSeveralBytesToo) {
  EXPECT_EQ(printable("a\u009b31mb\u202ec\u2066d\u2028", 40),
            "a\\xc2\\x9b31mb\\xe2\\x80\\xaec\\xe2\\x81\\xa6d\\xe2\\x80\\xa8");
  EXPECT_EQ(printable("\u00a0\u2026\u20ac\u2065", 40), "\u00a0\u2026\u20ac\u2065");
}

TEST(Harmless, KeepsLinesAndTabsAndEscapesAllElseThatATerminalObeys) {
  EXPECT_EQ(harmless("one\ttwo\nthree \u20ac\n"), "one\ttwo\nthree \u20ac\n");
  EXPECT_EQ(harmless("\x1b]0;x\x07\r\xFC\u0085"), "\\x1b]0;x\\x07\\r\\xfc\\xc2\\x85");
}

TEST(Harmless, JsonKeepsItsValues) {
  EXPECT_EQ(harmless_json("{\n \"a\x7f\u009b\u2028\u202e\u2069\": \"\u00e9\U0001f600\"\n}\n"),
            "{\n \"a\\u007f\\u009b\\u2028\\u202e\\u2069\": \"\u00e9\U0001f600\"\n}\n");
}

TEST(Printable, EndsAfterSoManyCharacters) {
  EXPECT_EQ(printable("üüü", 3), "üüü");
  EXPECT_EQ(printable("üüüü", 3), "üüü…");
  EXPECT_EQ(printable(std::string(5000000, 'x'), 2), "xx…");
}

TEST(XmlText, NamesWhatXmlKeepsForItself) {
  EXPECT_EQ(xml_text("a < b & \"c\" > 'd'\n"), "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;\n");
  EXPECT_EQ(xml_text("a\x1b\x01z"), "az");
}

TEST(XmlText, IsUtf8WhateverItIsGiven) {
  EXPECT_EQ(xml_text("Grün € \xF0\x9F\xAA\xA8"), "Grün € \xF0\x9F\xAA\xA8");
  EXPECT_EQ(xml_text("Gr\xFCn\xC3"), "Gr\xEF\xBF\xBDn\xEF\xBF\xBD");
  EXPECT_EQ(xml_text("\xEF\xBF\xBF"), "\xEF\xBF\xBD");
}

}  // namespace
}  // namespace keyblock
