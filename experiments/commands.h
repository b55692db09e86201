// The commands, apart from how their arguments are spelled.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/catalogue.h"
#include "experiments/spec.h"

namespace halfslope {

struct RunArguments {
  std::string file;                         ///< experiment.toml, or empty
  std::map<std::string, std::string> keys;  ///< keys of the experiment given as flags
  std::string out;
  int threads = 0;
  bool quiet = false, dry_run = false, overwrite = false, json = false;
};
int run_command(const RunArguments& arguments, const Catalogue& catalogue);

struct ListArguments {
  std::string what;  ///< samplers, estimators, scenes, measures, metrics, figures, statuses, or empty for all
  bool json = false, names_only = false;
};
int list_command(const ListArguments& arguments, const Catalogue& catalogue);

struct PointsArguments {
  std::string sampler;
  std::uint64_t count = 16, seed = 1;
  int dims = 2;
  std::uint32_t replicate = 0, pixel = 0;
  std::string precision = "f64";
};
int points_command(const PointsArguments& arguments, const Catalogue& catalogue);

struct MeasureArguments {
  std::string samplers;            ///< names, separated by commas
  std::vector<std::string> files;  ///< of points
  bool wrap = false, clamp = false;
  std::string counts;       ///< as --samples of `run`; empty: all points of the files
  std::optional<int> dims;  ///< default: the files' columns, else 2
  std::string measures = "star,l2-star";
  std::optional<std::int64_t> replicates;  ///< default: 1, with `summary` 64
  std::uint64_t seed = 1;
  std::string exr;
  int threads = 0;
  bool summary = false, json = false, quiet = false;
};
int measure_command(const MeasureArguments& arguments, const Catalogue& catalogue);

struct RenderArguments {
  std::string scene, estimator, sampler = "halton-owen", resolution, precision = "f32", out;
  std::uint64_t samples = 64, seed = 1;
  std::uint32_t replicate = 0;
  std::optional<int> max_depth;  ///< of paths
  double exposure = 0;           ///< of a PNG: radiance is multiplied by two to it
  int threads = 0;
  bool quiet = false;
};
int render_command(const RenderArguments& arguments, const Catalogue& catalogue);

struct ReferenceArguments {
  std::string scene, resolution, out;
  std::optional<std::uint64_t> samples;  ///< default: 2^19 for few pixels, 8192 for an image
  std::optional<double> relative_error;
  std::int64_t most_replicates = 1 << 14;
  int threads = 0;
  std::optional<int> max_depth;  ///< of paths
  bool quiet = false, no_cache = false, json = false, paths = false;
};
int reference_command(const ReferenceArguments& arguments, const Catalogue& catalogue);

struct FigureArguments {
  std::string name, out;                    ///< out: NAME.png where empty
  std::map<std::string, std::string> keys;  ///< flags that belong to some of the figures; switches have empty values
  std::vector<std::string> files;           ///< of points
  int threads = 0;
  bool quiet = false;
};
int figure_command(const FigureArguments& arguments, const Catalogue& catalogue);

struct ScenesCheckArguments {
  std::vector<std::string> files;  ///< scene files, with parameters perhaps, or names of shipped scenes
  bool json = false;
};
int scenes_check_command(const ScenesCheckArguments& arguments);

struct SelfcheckArguments {
  std::string what;                  ///< coverage
  std::vector<std::string> studies;  ///< names; empty: all
  std::optional<std::int64_t> runs;  ///< of every row; default: each study's own
  std::uint64_t seed = 1;
  int threads = 0;
  bool quiet = false, json = false;
};
int selfcheck_command(const SelfcheckArguments& arguments);

struct AnalyzeImagesArguments {
  std::string pattern, reference, layer, out;
  std::vector<std::string> halves;  ///< none or two
  int threads = 0;
  bool json = false, keep_going = false, quiet = false;
};
int analyze_images_command(const AnalyzeImagesArguments& arguments);

}  // namespace halfslope
