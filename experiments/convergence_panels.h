// How the lines of a run are spread over panels.
#pragma once

#include <string>
#include <vector>

#include "experiments/convergence_lines.h"

namespace halfslope {

struct PanelLine {
  const ConvergenceLine* line;
  std::string label;  ///< what tells it from the panel's others
  std::size_t look;   ///< index into looks()
};

struct ConvergencePanel {
  std::string title;             ///< what tells it from the other panels; empty for a lone one whose labels say it all
  std::string scene, precision;  ///< panels of one scene share their ranges
  std::vector<PanelLine> lines;
};

/// `panels`: one for each scene and precision where at most eight lines share it; else one for each estimator, whose
/// lines are samplers; and where these are more than eight, further panels of eight. A label has the same look in every
/// panel, if all labels together have looks enough. The lines must outlive the panels.
struct ConvergencePanels {
  std::vector<ConvergencePanel> panels;
  std::string common;  ///< scene, estimator, sampler and precision, each where all lines share it
};
ConvergencePanels convergence_panels(const std::vector<ConvergenceLine>& lines);

}  // namespace halfslope
