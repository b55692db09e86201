// A box with a large excess, by a random walk.
#pragma once

#include <cstddef>

#include "analysis/critical_boxes.h"

namespace halfslope {

/// The largest excess that a walk of threshold accepting meets, hence a lower bound of the largest there is, and in
/// practice often that. After M. Gnewuch, M. Wahlström, C. Winzen, "A new randomized algorithm to approximate the star
/// discrepancy based on threshold accepting", SIAM J. Numer. Anal. 50(2), 2012: closed and open boxes are walked apart;
/// each step redraws more and more of the sides, each from a shrinking neighbourhood with density proportional to
/// r^(d−1), which suits volumes; boxes snap to points; a step that loses less than a threshold is taken, and the
/// thresholds, losses of random steps at first, go to 0. Its random numbers have a key of their own: the same points
/// give the same bits.
///
/// `steps`: at least 1; the work of one is about N (d + 64)/64.
double threshold_accepting(const CriticalBoxes& boxes, std::size_t steps);

}  // namespace halfslope
