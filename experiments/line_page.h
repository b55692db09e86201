// A page of diagrams of lines.
#pragma once

#include <string>
#include <vector>

#include "analysis/line_chart.h"

namespace halfslope {

struct LinePage {
  std::string title;
  std::string subtitle;     ///< right of it, in grey: what all lines share
  std::string notes_title;  ///< of the legends' notes
  std::vector<LineChart> charts;
  bool legends = true;
  std::string caption;  ///< below, in as many lines as it takes
  std::string nothing;  ///< stands in a chart without a point
};

/// One chart has its legend to the right, several have theirs below, two or three side by side.
Canvas draw_line_page(const LinePage& page);

}  // namespace halfslope
