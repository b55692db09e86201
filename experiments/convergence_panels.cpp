#include "experiments/convergence_panels.h"

#include <algorithm>

#include "analysis/palette.h"
#include "experiments/figures.h"

namespace halfslope {
namespace {

using Lines = std::vector<const ConvergenceLine*>;
using Part = std::string ConvergenceLine::*;

/// The different values of a field, in order of first appearance.
std::vector<std::string> values_of(const Lines& lines, Part field) {
  std::vector<std::string> values;
  for (const ConvergenceLine* line : lines) {
    if (std::find(values.begin(), values.end(), line->*field) == values.end()) values.push_back(line->*field);
  }
  return values;
}

std::string label_of(const std::string& value, Part field) {
  return field == &ConvergenceLine::sampler ? sampler_label(value) : value;
}

std::string joined_parts(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() || part.empty() ? "" : ", ") + part;
  return text;
}

Lines with(const Lines& lines, Part field, const std::string& value) {
  Lines found;
  for (const ConvergenceLine* line : lines) {
    if (line->*field == value) found.push_back(line);
  }
  return found;
}

/// The panels of some lines of one scene and precision. Of `all` lines' parts, those that the panel's lines share are
/// in its title, the others in the labels.
void add_panels(const Lines& lines, const Lines& all, const std::string& title, std::vector<ConvergencePanel>& panels) {
  const auto varies = [](const Lines& some, Part part) { return values_of(some, part).size() > 1; };
  std::vector<std::string> titles = {title};
  for (const Part part : {&ConvergenceLine::estimator, &ConvergenceLine::sampler}) {
    if (varies(all, part) && !varies(lines, part) && lines.size() > 1)
      titles.push_back(label_of(lines.front()->*part, part));
  }
  for (std::size_t begin = 0; begin < lines.size(); begin += looks().size()) {
    ConvergencePanel panel{joined_parts(titles), lines.front()->scene, lines.front()->precision, {}};
    for (std::size_t k = begin; k < std::min(lines.size(), begin + looks().size()); ++k) {
      std::vector<std::string> parts;
      for (const Part part : {&ConvergenceLine::estimator, &ConvergenceLine::sampler}) {
        if (varies(all, part) && (varies(lines, part) || lines.size() == 1))
          parts.push_back(label_of(lines[k]->*part, part));
      }
      if (parts.empty()) parts = {lines[k]->estimator, sampler_label(lines[k]->sampler)};
      panel.lines.push_back({lines[k], joined_parts(parts), k - begin});
    }
    panels.push_back(std::move(panel));
  }
}

}  // namespace

ConvergencePanels convergence_panels(const std::vector<ConvergenceLine>& lines) {
  Lines all;
  for (const ConvergenceLine& line : lines) all.push_back(&line);
  const auto precisions = values_of(all, &ConvergenceLine::precision), scenes = values_of(all, &ConvergenceLine::scene);
  ConvergencePanels result;
  std::vector<ConvergencePanel>& panels = result.panels;
  for (const Part part :
       {&ConvergenceLine::scene, &ConvergenceLine::estimator, &ConvergenceLine::sampler, &ConvergenceLine::precision}) {
    if (const auto values = values_of(all, part); values.size() == 1)
      result.common = joined_parts({result.common, label_of(values.front(), part)});
  }
  for (const std::string& scene : scenes) {
    for (const std::string& precision : precisions) {
      const Lines group = with(with(all, &ConvergenceLine::scene, scene), &ConvergenceLine::precision, precision);
      if (group.empty()) continue;
      const std::string title = joined_parts({scenes.size() > 1 ? scene : "", precisions.size() > 1 ? precision : ""});
      if (group.size() <= looks().size()) {
        add_panels(group, all, title, panels);
        continue;
      }
      for (const std::string& estimator : values_of(group, &ConvergenceLine::estimator)) {
        add_panels(with(group, &ConvergenceLine::estimator, estimator), all, title, panels);
      }
    }
  }
  std::vector<std::string> labels;
  for (const ConvergencePanel& panel : panels) {
    for (const PanelLine& line : panel.lines) {
      if (std::find(labels.begin(), labels.end(), line.label) == labels.end()) labels.push_back(line.label);
    }
  }
  if (labels.size() > looks().size()) return result;
  for (ConvergencePanel& panel : panels) {
    for (PanelLine& line : panel.lines) {
      line.look = static_cast<std::size_t>(std::find(labels.begin(), labels.end(), line.label) - labels.begin());
    }
  }
  return result;
}

}  // namespace halfslope
