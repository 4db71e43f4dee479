#include "core/error.h"

#include <gtest/gtest.h>

namespace keyblock {
namespace {

Diagnostic complete_diagnostic() {
  Diagnostic d;
  d.where = {"tunnel.toml", 12, 3};
  d.key = "rock.young";
  d.found = "-1";
  d.expected = "a number above 0";
  d.hint = "Pa, as in 3.0e9";
  return d;
}
const Diagnostic complete = complete_diagnostic();

TEST(Diagnostic, NamesFilePositionKeyFoundExpectedHint) {
  EXPECT_EQ(complete.to_string(),
            "tunnel.toml:12:3: rock.young: found -1; expected a number above 0; Pa, as in 3.0e9");
}

TEST(Diagnostic, LeavesOutWhatIsNotKnown) {
  Diagnostic d = complete;
  d.where.line = 0;
  EXPECT_EQ(d.to_string(), "tunnel.toml: rock.young: found -1; expected a number above 0; Pa, as in 3.0e9");
  d.hint.clear();
  d.key.clear();
  EXPECT_EQ(d.to_string(), "tunnel.toml: found -1; expected a number above 0");
  d.found.clear();
  EXPECT_EQ(d.to_string(), "tunnel.toml: expected a number above 0");
  d.where.file.clear();
  EXPECT_EQ(d.to_string(), "expected a number above 0");
}

TEST(Diagnostic, IsOneLineOfReasonableLength) {
  Diagnostic d = complete;
  d.found = std::string(5000000, '7') + "\n";
  EXPECT_LT(d.to_string().size(), 1000U);
  d.found = "\"\x1b[31m\xFC\n\"";
  EXPECT_EQ(d.to_string(),
            "tunnel.toml:12:3: rock.young: found \"\\x1b[31m\\xfc\\n\"; expected a number above 0; Pa, as in "
            "3.0e9");
}

TEST(InputError, CarriesEveryMistake) {
  Diagnostic second = complete;
  second.key = "rock.poisson";
  const InputError error(std::vector{complete, second});
  ASSERT_EQ(error.diagnostics().size(), 2U);
  EXPECT_EQ(error.diagnostics()[1].key, "rock.poisson");
  EXPECT_EQ(error.what(), complete.to_string() + "\n" + second.to_string());
}

TEST(InputError, OfOneMistake) {
  const InputError error(complete);
  ASSERT_EQ(error.diagnostics().size(), 1U);
  EXPECT_EQ(error.what(), complete.to_string());
}

}  // namespace
}  // namespace keyblock
