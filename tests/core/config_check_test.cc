#include "core/config_check.h"

#include <gtest/gtest.h>

#include <limits>

namespace nightjar::core {
namespace {

struct Inner {
  double rate_hz = 1.0;
  template <class V>
  void visit(V& v) {
    v.field("rate_hz", rate_hz, 0.0, 10.0);
  }
};

struct Outer {
  int count = 3;
  std::array<double, 2> place_m = {0.0, 0.0};
  Inner inner;
  std::vector<Inner> many = {Inner{}};
  template <class V>
  void visit(V& v) {
    v.field("count", count, 1, 5);
    v.field("place_m", place_m, -1.0, 1.0);
    v.section("inner", inner);
    v.list("many", many, 1, 2);
  }
};

std::string message(const Outer& config) {
  try {
    check_config(config, "outer");
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(ConfigCheck, AcceptsValuesOnTheirBounds) {
  Outer config;
  config.count = 5;
  config.place_m = {-1.0, 1.0};
  config.inner.rate_hz = 0.0;
  EXPECT_EQ(message(config), "");
}

TEST(ConfigCheck, NamesPathValueAndRange) {
  Outer config;
  config.count = 6;
  EXPECT_EQ(message(config), "outer.count = 6, allowed 1 to 5");
  config.count = 3;
  config.place_m[1] = 1.5;
  EXPECT_EQ(message(config), "outer.place_m[1] = 1.5, allowed -1 to 1");
  config.place_m[1] = 0;
  config.inner.rate_hz = -0.1;
  EXPECT_EQ(message(config), "outer.inner.rate_hz = -0.1, allowed 0 to 10");
  config.inner.rate_hz = 1;
  config.many.push_back({11});
  EXPECT_EQ(message(config), "outer.many[1].rate_hz = 11, allowed 0 to 10");
}

TEST(ConfigCheck, NotANumberIsOutOfRange) {
  Outer config;
  config.inner.rate_hz = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message(config), "outer.inner.rate_hz = nan, allowed 0 to 10");
}

TEST(ConfigCheck, CountsTheElementsOfAList) {
  Outer config;
  config.many.clear();
  EXPECT_EQ(message(config), "outer.many.size = 0, allowed 1 to 2");
}

}  // namespace
}  // namespace nightjar::core
