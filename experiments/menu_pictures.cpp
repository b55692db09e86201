#include <memory>
#include <utility>

#include "estimators/path_transport.h"
#include "experiments/commands.h"
#include "experiments/menu.h"

namespace halfslope {

Command add_render(CLI::App& app) {
  const auto kept = std::make_shared<RenderArguments>();
  RenderArguments& render = *kept;
  CLI::App* command = app.add_subcommand("render", "render one replicate to an EXR or PNG image");
  command->add_option("--scene", render.scene, "catalogue name or .xml path")->required()->type_name("SCENE");
  command->add_option("--estimator", render.estimator, "see `halfslope list estimators` (default: balance, or mean)")
      ->type_name("NAME");
  command->add_option("--sampler", render.sampler, "see `halfslope list samplers`")
      ->capture_default_str()
      ->type_name("NAME");
  command->add_option("--samples", render.samples, "N per pixel")->capture_default_str()->type_name("N");
  add_seed(*command, render.seed);
  command->add_option("--replicate", render.replicate, "which randomisation")->capture_default_str()->type_name("K");
  command->add_option("--resolution", render.resolution, "WIDTH,HEIGHT")->type_name("W,H");
  command->add_option("--max_depth", render.max_depth, "of paths: 1 sees emitters, 2 light that is scattered once")
      ->type_name("D")
      ->check(CLI::Range(1, kMostDepth));
  command->add_option("--precision", render.precision, "f32 or f64")->capture_default_str()->type_name("P");
  command->add_option("--out,-o", render.out, "image file, .exr or .png (default: SCENE.exr)")->type_name("FILE");
  command->add_option("--exposure", render.exposure, "of a .png: radiance is multiplied by 2^STOPS")
      ->type_name("STOPS");
  add_threads(*command, render.threads, "threads (default: all cores)");
  command->add_flag("--quiet", render.quiet, "no progress");
  return {command, [kept](const Catalogue& catalogue) { return render_command(*kept, catalogue); }};
}

Command add_reference(CLI::App& app) {
  const auto kept = std::make_shared<ReferenceArguments>();
  ReferenceArguments& reference = *kept;
  CLI::App* command =
      app.add_subcommand("reference", "print or render a scene's reference values, with standard errors");
  command->add_option("--scene", reference.scene, "catalogue name or .xml path")->required()->type_name("SCENE");
  command->add_option("--resolution", reference.resolution, "WIDTH,HEIGHT")->type_name("W,H");
  command
      ->add_option("--samples", reference.samples,
                   "N of each replicate (default 2^19 up to 64 pixels, up to 2^28 where that is not enough, else 8192)")
      ->type_name("N");
  command
      ->add_option("--relative-error", reference.relative_error,
                   "rms of the pixels' relative standard errors to reach (default 1e-5 up to 64 pixels, else 1e-3)")
      ->type_name("X");
  command
      ->add_option("--max-replicates", reference.most_replicates,
                   "the most replicates to spend; an error if they do not suffice")
      ->capture_default_str()
      ->type_name("R")
      ->check(CLI::Range(16, 1 << 24));
  command->add_option("--out,-o", reference.out, "write an EXR instead of CSV")->type_name("FILE");
  add_threads(*command, reference.threads, "threads (default: all cores)");
  command->add_flag("--paths", reference.paths, "of all light along paths, not of direct light alone");
  command->add_option("--max_depth", reference.max_depth, "of --paths: 1 sees emitters, 2 light that is scattered once")
      ->type_name("D")
      ->check(CLI::Range(1, kMostDepth));
  command->add_flag("--no-cache", reference.no_cache, "neither read nor write the cache of references");
  command->add_flag("--json", reference.json, "as JSON");
  command->add_flag("--quiet", reference.quiet, "no progress");
  return {command, [kept](const Catalogue& catalogue) { return reference_command(*kept, catalogue); }};
}

Command add_figure(CLI::App& app) {
  const auto kept = std::make_shared<FigureArguments>();
  FigureArguments& figure = *kept;
  CLI::App* command = app.add_subcommand("figure", "draw a figure for print: PNG or SVG");
  command->add_option("name", figure.name, "see `halfslope list figures`")->required()->type_name("NAME");
  command->add_option("--out,-o", figure.out, "FILE.png (288 pixels an inch) or FILE.svg (default: NAME.png)")
      ->type_name("FILE");
  for (const auto& [spelling, help] : std::vector<std::pair<std::string, std::string>>{
           {"--run", "convergence, work-precision, rates: the run folder to draw"},
           {"--scene", "veach, glossy: which scene; convergence, work-precision, rates: only these"},
           {"--estimators,--estimator",
            "veach, glossy: a picture each; convergence, work-precision, rates: only these"},
           {"--samplers,--sampler",
            "a picture, a panel or a line each; convergence, work-precision, rates: only these"},
           {"--precision", "convergence, work-precision, rates: only f32 or f64"},
           {"--samples", "N a pixel, or how many points; discrepancy: 16:4096 for powers of two, or a list"},
           {"--resolution", "veach, glossy: WIDTH,HEIGHT of each picture"},
           {"--exposure", "veach, glossy: radiance is multiplied by 2^STOPS (default 0)"},
           {"--axes", "points: which two dimensions, such as 4,5 (default 0,1)"},
           {"--dims", "discrepancy, pcf: dimensions (default 2)"},
           {"--measures",
            "discrepancy: a diagram each (default star); spectrum, radial-spectrum, pcf: with parameters"},
           {"--replicates", "discrepancy, spectrum, radial-spectrum, pcf: randomisations"},
           {"--seed", "of the random numbers (default 1)"},
           {"--replicate", "veach, points, glossy: which randomisation (default 0)"}}) {
    const std::string key = spelling.substr(2, spelling.find(',') - 2);
    command
        ->add_option_function<std::string>(
            spelling, [kept, key](const std::string& value) { kept->keys[key] = value; }, help)
        ->type_name("VALUE");
  }
  command->add_option("--points", figure.files, "files of points beside the --samplers, a line each")
      ->type_name("FILE");
  const auto add_switch = [&](const std::string& key, const char* help) {
    return command->add_flag_callback(
        "--" + key, [kept, key] { kept->keys[key] = ""; }, help);
  };
  add_switch("wrap", "take points of files outside [0,1) modulo 1")
      ->excludes(add_switch("clamp", "move points of files outside [0,1) to its nearest end"));
  add_switch("side-by-side", "radial-spectrum, pcf: a diagram for each sampler");
  add_threads(*command, figure.threads, "threads; the figure does not depend on it (default: all cores)");
  command->add_flag("--quiet", figure.quiet, "no progress");
  return {command, [kept](const Catalogue& catalogue) { return figure_command(*kept, catalogue); }};
}

}  // namespace halfslope
