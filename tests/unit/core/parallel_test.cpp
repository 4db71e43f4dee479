#include "core/parallel.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"

namespace keyblock {
namespace {

class Team : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, Team, ::testing::Values(1, 2, 3, 7));

TEST_P(Team, CoversEveryIndexOnce) {
  ThreadTeam team(GetParam());
  for (const std::size_t n : {0U, 1U, 2U, 5U, 6U, 1000U}) {
    std::vector<int> visits(n, 0);
    team.for_range(n, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(visits, std::vector<int>(n, 1)) << n;
  }
}

TEST_P(Team, SameBitsAsOneThread) {
  const auto compute = [](int threads) {
    ThreadTeam team(threads);
    std::vector<double> values(5000, 0.0);
    for (int repeat = 0; repeat < 20; ++repeat) {
      team.for_range(values.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          values[i] = std::sin(values[i] + 0.1 * static_cast<double>(i + 1)) / 3.0;
        }
      });
    }
    std::vector<std::uint64_t> bits;
    for (const double v : values) bits.push_back(std::bit_cast<std::uint64_t>(v));
    return bits;
  };
  EXPECT_EQ(compute(GetParam()), compute(1));
}

TEST_P(Team, FindsAllAndTheLargest) {
  ThreadTeam team(GetParam());
  const auto value = [](std::size_t i) { return std::sin(0.7 * static_cast<double>(i)); };
  for (const std::size_t n : {0U, 1U, 10'000U}) {
    std::vector<std::size_t> expected, found{99};
    double largest = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      if (value(i) > 0.9) expected.push_back(i);
      largest = std::max(largest, value(i));
    }
    for (const std::size_t grain : {1U, 100'000U}) {
      find_all(
          team, n, grain, [&](std::size_t i) { return value(i) > 0.9; }, found);
      EXPECT_EQ(found, expected) << n;
      EXPECT_EQ(largest_of(team, n, grain, value), largest) << n;
    }
  }
  EXPECT_EQ(largest_of(team, 100, 1, [](std::size_t) { return -1.0; }), 0.0);
}

TEST_P(Team, ThrowsWhatThePieceThrewAndWorksOn) {
  ThreadTeam team(GetParam());
  for (const std::size_t bad : {std::size_t{0}, std::size_t{99}}) {  // in the first piece, and in the last
    std::atomic<int> seen = 0;
    const auto loop = [&] {
      team.for_range(100, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          ++seen;
          if (i == bad) throw std::domain_error("bad index");
        }
      });
    };
    EXPECT_THROW(loop(), std::domain_error);
    EXPECT_GE(seen, 1);
  }
  std::atomic<int> seen = 0;
  team.for_range(100, 1, [&](std::size_t begin, std::size_t end) { seen += static_cast<int>(end - begin); });
  EXPECT_EQ(seen, 100);
}

TEST_P(Team, ReportsOneErrorWhenAllPiecesThrow) {
  ThreadTeam team(GetParam());
  const auto body = [](std::size_t, std::size_t) { throw std::domain_error("every piece"); };
  EXPECT_THROW(team.for_range(100, 1, body), std::domain_error);
  EXPECT_THROW(team.for_range(100, 1, body), std::domain_error);
}

TEST_P(Team, ThrowsTheFirstOfSeveralErrorsAndForgetsTheOthers) {
  ThreadTeam team(GetParam());
  const auto body = [](std::size_t begin, std::size_t) { throw std::domain_error(std::to_string(begin)); };
  try {
    team.for_range(100, 1, body);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const std::domain_error& e) {
    EXPECT_STREQ(e.what(), "0");
  }
  EXPECT_NO_THROW(team.for_range(100, 1, [](std::size_t, std::size_t) {}));
}

TEST_P(Team, ShortLoopsStayInTheCallingThread) {
  ThreadTeam team(GetParam());
  std::mutex mutex;
  std::vector<std::thread::id> threads;
  const auto body = [&](std::size_t, std::size_t) {
    std::lock_guard lock(mutex);
    threads.push_back(std::this_thread::get_id());
  };
  team.for_range(9, 10, body);
  EXPECT_EQ(threads, std::vector{std::this_thread::get_id()});
  threads.clear();
  team.for_range(10, 10, body);
  EXPECT_EQ(threads.size(), static_cast<std::size_t>(GetParam()));
}

TEST(ThreadTeam, HasAtLeastOneThread) {
  EXPECT_EQ(ThreadTeam(0).size(), 1);
  EXPECT_EQ(ThreadTeam(-3).size(), 1);
  EXPECT_EQ(ThreadTeam(4).size(), 4);
}

/// Makes a team of many threads with address space for a few of them.
[[noreturn]] void make_team_without_room() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlim_t room = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + (rlim_t{128} << 20);
  const rlimit limit{room, room};
  ::setrlimit(RLIMIT_AS, &limit);
  try {
    const ThreadTeam team(1024);
  } catch (const RunError& e) {
    std::fprintf(stderr, "%s\n", e.what());
    std::_Exit(0);
  }
  std::_Exit(1);
}

TEST(ThreadTeam, SaysWhenTheSystemHasNoMoreThreads) {
  EXPECT_EXIT(make_team_without_room(), ::testing::ExitedWithCode(0),
              "of the 1024 threads asked for, only [0-9]+ could be started: ");
}

}  // namespace
}  // namespace keyblock
