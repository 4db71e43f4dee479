#include "results/csv.h"

#include <gtest/gtest.h>

namespace keyblock::results {
namespace {

TEST(CsvField, IsQuotedWhereItWouldFallApart) {
  EXPECT_EQ(csv_field("crown"), "crown");
  EXPECT_EQ(csv_field(""), "");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"a\""), "\"say \"\"a\"\"\"");
  EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
  EXPECT_EQ(csv_field("a;b"), "\"a;b\"");
}

TEST(CsvField, ThatASpreadsheetWouldRunIsText) {
  EXPECT_EQ(csv_field("=1+1"), "'=1+1");
  EXPECT_EQ(csv_field("+cmd"), "'+cmd");
  EXPECT_EQ(csv_field("-2+3"), "'-2+3");
  EXPECT_EQ(csv_field("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(csv_field("\t=1"), "\"'\t=1\"");
  EXPECT_EQ(csv_field("\r=1"), "\"'\r=1\"");
  EXPECT_EQ(csv_field("  =1"), "'  =1");
  EXPECT_EQ(csv_field("-5, =1"), "\"'-5, =1\"");
  EXPECT_EQ(csv_field("=HYPERLINK(\"x\")"), "\"'=HYPERLINK(\"\"x\"\")\"");
}

TEST(CsvField, NumbersStayNumbers) {
  for (const char* text : {"-1", "+1", "-0.5", "1e9", "-1.5e-3", "-inf", "-.5", "a-b", "a=b", "-1e999"})
    EXPECT_EQ(csv_field(text), text);
  EXPECT_EQ(csv_field("-0.5, +1"), "\"-0.5, +1\"");
}

}  // namespace
}  // namespace keyblock::results
