#pragma once

#include <map>
#include <string>
#include <string_view>

namespace nightjar::camera {

/// The attributes in the header of an AEDAT4 file, by their nodes' names joined with '/':
/// "outInfo/0/info/sizeX" -> "346". Of XML it knows just what these headers are made of:
/// <dv>, <node name="...">, <attr key="...">text</attr>, and the five entities. Throws
/// std::invalid_argument (without the place) for what does not nest, more than 16 deep too.
std::map<std::string, std::string> read_info_xml(std::string_view xml);

/// `text` with entities for what means something to XML.
std::string escaped_xml(std::string_view text);

}  // namespace nightjar::camera
