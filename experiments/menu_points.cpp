#include <memory>

#include "experiments/commands.h"
#include "experiments/menu.h"

namespace halfslope {

Command add_points(CLI::App& app) {
  const auto kept = std::make_shared<PointsArguments>();
  PointsArguments& points = *kept;
  CLI::App* command = app.add_subcommand("points", "print a sampler's points as CSV");
  command->add_option("--sampler", points.sampler, "see `halfslope list samplers`")->required()->type_name("NAME");
  command->add_option("--count", points.count, "number of points N")
      ->capture_default_str()
      ->type_name("N")
      ->check(whole_number());
  command->add_option("--dims", points.dims, "dimensions, grouped in pairs")->capture_default_str()->type_name("D");
  command->add_option("--replicate", points.replicate, "which randomisation")->capture_default_str()->type_name("K");
  command->add_option("--pixel", points.pixel, "which pixel's")->capture_default_str()->type_name("P");
  add_seed(*command, points.seed);
  command->add_option("--precision", points.precision, "f32 or f64")->capture_default_str()->type_name("P");
  return {command, [kept](const Catalogue& catalogue) { return points_command(*kept, catalogue); }};
}

Command add_measure(CLI::App& app) {
  const auto kept = std::make_shared<MeasureArguments>();
  MeasureArguments& measure = *kept;
  CLI::App* command =
      app.add_subcommand("measure", "measure points: discrepancies, distances, spectra, as CSV or JSON");
  command->add_option("--sampler,--samplers", measure.samplers, "one or several, see `halfslope list samplers`")
      ->expected(-1)
      ->join(',')
      ->type_name("NAME");
  command->add_option("--points", measure.files, "one or several files of points, a line each; sets are replicates")
      ->type_name("FILE");
  command->add_option("--count", measure.counts, "N: 1024, 16:1024 for powers of two, or a list (of files: all)")
      ->type_name("N");
  command->add_option("--dims", measure.dims, "dimensions (default: 2, or the files' columns)")->type_name("D");
  command
      ->add_option("--measures", measure.measures,
                   "see `halfslope list measures`; or all, for those that are one number")
      ->capture_default_str()
      ->type_name("NAME,...");
  command
      ->add_option("--replicates", measure.replicates,
                   "randomisations (default 1, with --summary 64; of files: the sets)")
      ->type_name("R");
  add_seed(*command, measure.seed);
  CLI::Option* wrap = command->add_flag("--wrap", measure.wrap, "take points outside [0,1) modulo 1");
  command->add_flag("--clamp", measure.clamp, "move points outside [0,1) to its nearest end")->excludes(wrap);
  command->add_flag("--summary", measure.summary, "mean over replicates and its 95 % interval instead of each");
  command->add_option("--exr", measure.exr, "write the mean spectrum as an image too")->type_name("FILE");
  command->add_flag("--json", measure.json, "as JSON");
  add_threads(*command, measure.threads, "threads; the results do not depend on it (default: all cores)");
  command->add_flag("--quiet", measure.quiet, "no progress, and not what is left out");
  return {command, [kept](const Catalogue& catalogue) { return measure_command(*kept, catalogue); }};
}

}  // namespace halfslope
