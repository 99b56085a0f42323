// Seeds of property tests: every random draw has one, and a failure prints how to repeat it.
#pragma once

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace raycell::property {

/// `count` seeds from `first` on, or only the seed in RAYCELL_TEST_SEED, if set.
inline std::vector<std::uint64_t> seeds(std::uint64_t first, int count) {
    if (const char* only = std::getenv("RAYCELL_TEST_SEED")) return {std::strtoull(only, nullptr, 10)};
    std::vector<std::uint64_t> all;
    for (int i = 0; i < count; ++i) all.push_back(first + std::uint64_t(i));
    return all;
}

/// For SCOPED_TRACE: the seed and the command that repeats it.
inline std::string rerun(std::uint64_t seed) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    return "seed " + std::to_string(seed) + "; again with: RAYCELL_TEST_SEED=" + std::to_string(seed) + " " +
           program_invocation_short_name + " --gtest_filter='" + test->test_suite_name() + "." +
           test->name() + "'";
}

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
    bool chance(double share) { return uniform(0, 1) < share; }
    std::mt19937_64& engine() { return engine_; }

  private:
    std::mt19937_64 engine_;
};

}  // namespace raycell::property
