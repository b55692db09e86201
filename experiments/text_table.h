// Tables for people.
#pragma once

#include <string>
#include <vector>

namespace halfslope {

/// Columns as wide as their widest cell; the first `left` of them flush left, the others flush right. Each line is
/// indented by two spaces.
std::string align(const std::vector<std::vector<std::string>>& rows, std::size_t left);

}  // namespace halfslope
