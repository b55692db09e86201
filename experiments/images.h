// The EXR files of a run folder.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/exr.h"
#include "experiments/fold.h"
#include "experiments/plan.h"
#include "experiments/reference.h"

namespace halfslope {

/// images/<scene>/<precision>/<estimator>/<sampler>/<samples>.exr: R, G, B the mean over replicates, and the layers
/// `variance` (over replicates, R − 1), `mse` and `bias` against the reference, pixel by pixel.
void write_cell_image(const std::filesystem::path& folder, const Plan& plan, const Cell& cell, const FoldedCell& folded,
                      const std::vector<Reference>& references);

/// reference.exr, or reference-<scene>.exr where several scenes have pictures: R, G, B and the layers `variance`,
/// `half_a` and `half_b`.
void write_reference_images(const std::filesystem::path& folder, const Plan& plan,
                            const std::vector<Reference>& references);

/// Values over all pixels of a scene, pixel-major, as R, G, B.
ExrImage picture(const IntegralSource& source, std::span<const double> values);

/// The picture of a reference over all pixels of its scene, with all its layers.
ExrImage reference_image(const IntegralSource& source, const Reference& reference);

/// A name as one component of a path: '/' becomes '_', and of a name above 200 bytes a hash and its end remain.
std::string path_component(const std::string& name);

/// Error(kBadInput) where two scenes or samplers would have their images in the same folder.
void check_image_folders(const Spec& spec);

}  // namespace halfslope
