#include "camera/info_xml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace nightjar::camera {
namespace {

using testing::ElementsAre;
using testing::Pair;

TEST(InfoXmlTest, names_attributes_by_the_nodes_they_are_in) {
  EXPECT_THAT(read_info_xml("<dv version=\"2.0\"><node name=\"a\" path=\"/a/\">"
                            "<attr key=\"k\" type=\"int\">7</attr><node name=\"b\">"
                            "<attr key=\"l\" type=\"string\">x &lt;y&gt; &amp;amp;</attr></node>"
                            "<node name=\"c\"/></node></dv>"),
              ElementsAre(Pair("a/b/l", "x <y> &amp;"), Pair("a/k", "7")));
}

TEST(InfoXmlTest, writes_any_text_so_that_it_reads_the_same) {
  const std::string odd = "a<b>\"c\"&'d'&amp;";
  const auto read = read_info_xml("<attr key=\"k\">" + escaped_xml(odd) + "</attr>");
  EXPECT_EQ(read.at("k"), odd);
}

TEST(InfoXmlTest, refuses_what_does_not_nest) {
  std::string deep;
  for (int i = 0; i < 17; ++i) deep += "<node name=\"a\">";
  for (const std::string& bad : {std::string("<node name=\"a\">"), std::string("</node>"),
                                 std::string("<attr key=\"k\">7"), std::string("<attr"), deep})
    EXPECT_THROW(read_info_xml(bad), std::invalid_argument) << bad;
}

}  // namespace
}  // namespace nightjar::camera
