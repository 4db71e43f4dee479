#include "loading/suite_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../fresh_folder.h"
#include "core/error.h"

namespace keyblock::loading {
namespace {

using testing::HasSubstr;

class SuiteList : public testing::Test {
 protected:
  SuiteList() {
    for (const char* name : {"a1.at2", "a2.at2", "a3.at2", "b1.at2", "b2.at2"})
      std::ofstream(folder_ / name) << "x";
  }
  std::vector<SuiteRecord> read(const std::string& text) {
    std::ofstream(folder_ / "list.csv") << text;
    return read_suite_list(folder_ / "list.csv");
  }
  /// The message that refuses the text.
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  }
  FreshFolder folder_;
};

TEST_F(SuiteList, HasColumnsByTheirNames) {
  const auto records = read(
      "# of a selection\nname,event,h1,h2,up,azimuth1,azimuth2,scale,magnitude,distance_km,colour\n"
      "\"A, first\",Irpinia,a1.at2,a2.at2,a3.at2,0,90,1.5,6.9,21.5,red\n\nB,Kobe,b1.at2,b2.at2,,,,,,,\n");
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(records[0].name, "A, first");
  EXPECT_EQ(records[0].up.filename(), "a3.at2");
  EXPECT_EQ(*records[0].azimuth2, 90.0);
  EXPECT_EQ(records[0].scale, 1.5);
  EXPECT_EQ(*records[0].magnitude, 6.9);
  EXPECT_EQ(records[1].event, "Kobe");
  EXPECT_TRUE(records[1].up.empty());
  EXPECT_EQ(records[1].scale, 1.0);
  EXPECT_FALSE(records[1].azimuth1);
  EXPECT_EQ(records[1].line, 5U);
}

// As the database writes it: other tables before and after, blanks around names and values, a dash for what is not there.
TEST_F(SuiteList, OfPeer) {
  const auto records = read(
      "PEER Ground Motion Database\n\n -- Summary of Metadata of Selected Records --\n"
      " Result ID, Spectral Ordinate, Record Sequence Number, MSE, Scale Factor, Tp-Pulse Period (sec), "
      "Earthquake "
      "Name, Magnitude, Rrup (km), Vs30 (m/sec), Horizontal-1 Acc. Filename, Horizontal-2 Acc. Filename, "
      "Vertical "
      "Acc. Filename\n"
      " 1, SRSS, 285, 0.01, 1.25, -, \"Irpinia, Italy-01\", 6.9, 8.18, 649.67, a1.at2, a2.at2, a3.at2\n"
      " 2, SRSS, 1111, 0.02, 0.80, 1.8, \"Kobe, Japan\", 6.9, 7.08, 609, b1.at2, b2.at2, -\n\n"
      " -- Scaled Spectra --\n T (s), RSN-285\n 0.01, 0.3\n");
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(records[0].name, "RSN285");
  EXPECT_EQ(records[0].event, "Irpinia, Italy-01");
  EXPECT_FALSE(records[0].pulse_period);
  EXPECT_EQ(*records[1].pulse_period, 1.8);
  EXPECT_EQ(records[1].scale, 0.8);
  EXPECT_TRUE(records[1].up.empty());
}

TEST_F(SuiteList, RefusesWhatIsWrongByLineAndColumn) {
  EXPECT_THAT(refusal("name,h1\nA,c1.at2\n"), HasSubstr("list.csv:2:3"));
  EXPECT_THAT(refusal("name,h1\nA,a1.at2\nA,b1.at2\n"), HasSubstr("a name that no other record has"));
  EXPECT_THAT(refusal("h1\na1.at2\na1.at2\n"), HasSubstr("each file once"));
  EXPECT_THAT(refusal("h1,event\na1.at2,Kobe\nb1.at2,\n"), HasSubstr("the earthquake of each record"));
  EXPECT_THAT(refusal("h1,h2,azimuth1,azimuth2\na1.at2,a2.at2,0,80\n"), HasSubstr("normal to the 0°"));
  EXPECT_THAT(refusal("h1,h2,azimuth1,azimuth2\na1.at2,a2.at2,0,\n"), HasSubstr("of both components"));
  EXPECT_THAT(refusal("h1,scale\na1.at2,-1\n"), HasSubstr("a factor above 0"));
  EXPECT_THAT(refusal("h1,weight\na1.at2,2\n"), HasSubstr("the column \"weight\""));
  EXPECT_THAT(refusal("name\nA\n"), HasSubstr("no column of the first horizontal component"));
  EXPECT_THAT(refusal("h1\n"), HasSubstr("no records"));
  EXPECT_THAT(refusal(""), HasSubstr("no line with the names of columns"));
  EXPECT_THAT(refusal("h1,name\na1.at2,\"A\n"), HasSubstr("a closing \""));
}

}  // namespace
}  // namespace keyblock::loading
