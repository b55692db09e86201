#include <memory>

#include "experiments/commands.h"
#include "experiments/menu.h"

namespace halfslope {

Command add_selfcheck(CLI::App& app) {
  const auto kept = std::make_shared<SelfcheckArguments>();
  SelfcheckArguments& selfcheck = *kept;
  CLI::App* command = app.add_subcommand("selfcheck", "measure again what is promised: the coverage of every interval");
  command->add_option("what", selfcheck.what, "coverage")->required()->type_name("WHAT");
  command->add_option("--study,--studies", selfcheck.studies, "only these (default: all)")
      ->delimiter(',')
      ->type_name("NAME,...");
  command->add_option("--runs", selfcheck.runs, "simulated experiments a row (default: each study's own)")
      ->type_name("N")
      ->check(CLI::Range(10, 100'000'000));
  add_seed(*command, selfcheck.seed);
  add_threads(*command, selfcheck.threads, "threads; the table does not depend on it (default: all)");
  command->add_flag("--json", selfcheck.json, "as JSON");
  command->add_flag("--quiet", selfcheck.quiet, "no progress");
  return {command, [kept](const Catalogue&) { return selfcheck_command(*kept); }};
}

Command add_analyze(CLI::App& app) {
  const auto kept = std::make_shared<AnalyzeImagesArguments>();
  AnalyzeImagesArguments& images = *kept;
  CLI::App* analyze_app = app.add_subcommand("analyze", "analyse what was made elsewhere: images");
  analyze_app->require_subcommand(1);
  CLI::App* command = analyze_app->add_subcommand("images", "tables of a run for EXR images of any renderer");
  command
      ->add_option("--pattern", images.pattern,
                   "paths with the fields {scene} {estimator} {sampler} {precision} {samples} {seed}, such as "
                   "'out/{estimator}/{sampler}/{samples}_{seed}.exr'; the seeds are the replicates")
      ->required()
      ->type_name("PATTERN");
  command->add_option("--reference", images.reference, "the image to measure against; may have {scene}")
      ->type_name("FILE");
  command
      ->add_option("--reference-halves", images.halves,
                   "two independent images of the reference's integrals, for errors that need no variance of it; "
                   "without --reference their mean is the reference")
      ->type_name("A B")
      ->expected(2);
  command->add_option("--layer", images.layer, "channels LAYER.R, LAYER.G, LAYER.B (or LAYER.Y) instead of R, G, B")
      ->type_name("LAYER");
  command->add_option("--out", images.out, "folder of the tables (default: out/images)")->type_name("DIR");
  add_threads(*command, images.threads, "threads; the results do not depend on it (default: all cores)");
  command->add_flag("--json", images.json, "print the rows of convergence.csv as JSON instead of the summary");
  command->add_flag("--keep-going", images.keep_going, "exit 0 though files were missing, broken or not finite");
  command->add_flag("--quiet", images.quiet, "no progress, no summary");
  return {command, [kept](const Catalogue&) { return analyze_images_command(*kept); }};
}

}  // namespace halfslope
