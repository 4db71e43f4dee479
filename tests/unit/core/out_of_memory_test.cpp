#include "core/out_of_memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace keyblock {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Property;
using testing::Throws;

TEST(OutOfMemory, IsAnErrorOfTheRunThatSaysWhatForAndHowMuch) {
  const auto purpose = [] { return std::string("a model of 7 blocks"); };
  const auto fails = [&] { with_memory_for(purpose, [] { throw std::bad_alloc(); }); };
  EXPECT_THAT(fails, Throws<RunError>(Property(&RunError::what,
                                               AllOf(HasSubstr("out of memory for a model of 7 blocks: 0."),
                                                     HasSubstr("GB were taken")))));
  EXPECT_EQ(with_memory_for(purpose, [] { return 7; }), 7);
}

TEST(OutOfMemory, OtherErrorsStay) {
  const auto purpose = [] { return std::string(); };
  const auto fails = [&] { with_memory_for(purpose, [] { throw InputError(Diagnostic{}); }); };
  EXPECT_THROW(fails(), InputError);
}

}  // namespace
}  // namespace keyblock
