#include "scenarios/gnuplot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace nightjar::scenarios {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Gnuplot, gives_back_what_it_draws) {
  EXPECT_THAT(run_gnuplot("set terminal dumb\nplot [0:1] x title 'line'\n"), HasSubstr("line"));
}

TEST(Gnuplot, an_empty_script_draws_nothing) { EXPECT_EQ(run_gnuplot(""), ""); }

TEST(Gnuplot, a_script_that_it_refuses_is_an_error_that_says_why) {
  EXPECT_THAT([] { run_gnuplot("set terminal dumb\nplot no_such_function(x)\n"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("undefined function")));
}

TEST(Gnuplot, odd_text_stands_for_itself) {
  const std::string text = gnuplot_text("it's `date` \"$x\" @y\n");
  EXPECT_EQ(text, "'it''s `date` \"$x\" @y '");
  EXPECT_EQ(run_gnuplot("set print '-'\nprint " + text), "it's `date` \"$x\" @y \n");
}

}  // namespace
}  // namespace nightjar::scenarios
