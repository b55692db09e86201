#include "experiments/command_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <exception>
#include <new>

#include "core/error.h"
#include "core/version.h"
#include "experiments/commands.h"
#include "experiments/message.h"
#include "experiments/spec_keys.h"

namespace halfslope {
namespace {

// What each key of an experiment means, for --help of `run`.
std::string key_help(const std::string& key) {
  static const std::map<std::string, std::string> kHelp = {
      {"name", "the experiment's name; the default run folder is out/NAME"},
      {"scene", "see `halfslope list scenes`; or paths of Mitsuba 3 .xml files"},
      {"estimators",
       "HEURISTIC[:PARAMETER][@TECHNIQUE[*COUNT]+...], or a technique; default: light, bsdf, average, balance, "
       "power, or what the scene has instead"},
      {"samplers", "see `halfslope list samplers`"},
      {"samples", "sample counts N: 4:1024 for the powers of two from 4 to 1024, or a list"},
      {"replicates", "independent repetitions that errors are measured over (default 64)"},
      {"seed", "of every random number (default 1)"},
      {"resolution", "WIDTH,HEIGHT; default: the scene's own"},
      {"pixels", "all, or how many to measure (default all)"},
      {"images", "sample counts to write EXRs for, or none (default none)"},
      {"precision", "f32, f64 or f32,f64 (default f32)"},
      {"measures", "of the samplers' points, see `halfslope list measures`, or none (default none)"},
      {"interval", "of the RMSE: bootstrap-t, chi2, delta, bca or reciprocal-t (default bootstrap-t)"},
      {"target", "'rmse 5%': replicates are added until every rmse is known to ±5 %, at most --replicates (4096)"},
      {"budget", "60s, 2min or 1h: replicates are added where they narrow most, until the time is spent"},
      {"timing", "how often to time every cell by itself, such as 15, or none (default none)"},
      {"checks",
       "theorems to hold the results against, balance-bound,one-sample-balance,average-bound,exact-variance, or none "
       "(default none)"},
  };
  const auto found = kHelp.find(key);
  return found == kHelp.end() ? "" : found->second;
}

/// " --flag --other", and the same of what the command is followed by.
std::string completion_words(const CLI::App& command) {
  std::string words;
  for (const CLI::Option* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) {
      if (name != "help") words += " --" + name;
    }
  }
  for (const CLI::App* next : command.get_subcommands([](const CLI::App*) { return true; }))
    words += " " + next->get_name() + completion_words(*next);
  return words;
}

// Every command and its flags, for the shell.
std::string bash_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    const std::string flags = "--help" + completion_words(*command);
    commands += (commands.empty() ? "" : " ") + command->get_name();
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), flags);
  }
  return "_halfslope() {\n  local current=\"${COMP_WORDS[COMP_CWORD]}\" previous=\"${COMP_WORDS[COMP_CWORD-1]}\" "
         "words\n"
         "  case \"$previous\" in\n"
         "    --sampler|--samplers) words=\"$(halfslope list samplers --names)\" ;;\n"
         "    --scene) words=\"$(halfslope list scenes --names)\" ;;\n"
         "    --measures) words=\"$(halfslope list measures --names) none\" ;;\n"
         "    figure) words=\"$(halfslope list figures --names)\" ;;\n"
         "    selfcheck) words=\"coverage\" ;;\n"
         "    list) words=\"samplers estimators scenes measures metrics figures statuses\" ;;\n"
         "    *) case \"${COMP_WORDS[1]}\" in\n" +
         cases + "    *) words=\"" + commands +
         "\" ;;\n    esac ;;\n  esac\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\") $(compgen -f -- \"$current\"))\n}\n"
         "complete -o filenames -F _halfslope halfslope\n";
}

/// Refuses what is no whole number from 0 to 2^64 - 1: converted, it would silently become another one.
const CLI::Validator& whole_number() {
  static const CLI::Validator validator(
      [](std::string& text) {
        std::uint64_t value = 0;
        const char* end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc() && rest == end) return std::string();
        return fmt::format("found '{}'; allowed: an integer from 0 to 2^64 - 1", text);
      },
      "");
  return validator;
}

int parse_and_run(int argc, const char* const* argv, const Catalogue& catalogue) {
  CLI::App app{"halfslope: convergence analysis for Monte Carlo and quasi-Monte Carlo rendering", "halfslope"};
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  app.footer(
      "Environment: HALFSLOPE_ISA (scalar, baseline, avx2, avx512) chooses the kernels, HALFSLOPE_CACHE the folder of "
      "references, HALFSLOPE_KERNELS where kernels are looked for first.\n"
      "Exit codes: 0 done, 1 a check failed or a cell is invalid, 2 usage, 3 bad input, 4 input/output, 130 "
      "interrupted.");

  RunArguments run;
  CLI::App* run_app = app.add_subcommand("run", "run an experiment: every estimator x sampler over many replicates");
  run_app->add_option("experiment", run.file, "an experiment file (.toml); flags override it");
  for (const auto& key : spec_key_names()) {
    run_app
        ->add_option_function<std::string>(
            "--" + key, [&run, key](const std::string& value) { run.keys[key] = value; }, key_help(key))
        ->type_name("VALUE");
  }
  run_app->add_option("--out", run.out, "run folder (default: out/NAME)")->type_name("DIR");
  run_app->add_option("--threads", run.threads, "threads; the results do not depend on it (default: all cores)")
      ->check(CLI::Range(1, 4096));
  run_app->add_flag("--quiet", run.quiet, "no progress, no summary");
  run_app->add_flag("--dry-run", run.dry_run, "print the plan and what is skipped and why; measure nothing");
  run_app->add_flag("--overwrite", run.overwrite, "remove the results that the run folder holds and start afresh");
  run_app->add_flag("--json", run.json, "print the rows of convergence.csv as JSON instead of the summary");

  ListArguments list;
  bool names_only = false;
  CLI::App* list_app =
      app.add_subcommand("list", "list samplers, estimators, scenes, measures, metrics, figures and statuses");
  list_app->add_option("what", list.what, "samplers, estimators, scenes, measures, metrics, figures or statuses");
  list_app->add_flag("--json", list.json, "as JSON");
  list_app->add_flag("--names", names_only, "names alone, a line each");

  PointsArguments points;
  CLI::App* points_app = app.add_subcommand("points", "print a sampler's points as CSV");
  points_app->add_option("--sampler", points.sampler, "see `halfslope list samplers`")->required()->type_name("NAME");
  points_app->add_option("--count", points.count, "number of points N")
      ->capture_default_str()
      ->type_name("N")
      ->check(whole_number());
  points_app->add_option("--dims", points.dims, "dimensions, grouped in pairs")->capture_default_str()->type_name("D");
  points_app->add_option("--replicate", points.replicate, "which randomisation")->capture_default_str()->type_name("K");
  points_app->add_option("--pixel", points.pixel, "which pixel's")->capture_default_str()->type_name("P");
  points_app->add_option("--seed", points.seed, "of the random numbers")
      ->capture_default_str()
      ->type_name("S")
      ->check(whole_number());
  points_app->add_option("--precision", points.precision, "f32 or f64")->capture_default_str()->type_name("P");

  MeasureArguments measure;
  std::vector<std::string> measured_samplers;
  CLI::App* measure_app =
      app.add_subcommand("measure", "measure points: discrepancies, distances, spectra, as CSV or JSON");
  measure_app->add_option("--sampler,--samplers", measured_samplers, "one or several, see `halfslope list samplers`")
      ->type_name("NAME");
  measure_app->add_option("--points", measure.files, "one or several files of points, a line each; sets are replicates")
      ->type_name("FILE");
  measure_app->add_option("--count", measure.counts, "N: 1024, 16:1024 for powers of two, or a list (of files: all)")
      ->type_name("N");
  measure_app->add_option("--dims", measure.dims, "dimensions (default: 2, or the files' columns)")->type_name("D");
  measure_app
      ->add_option("--measures", measure.measures,
                   "see `halfslope list measures`; or all, for those that are one number")
      ->capture_default_str()
      ->type_name("NAME,...");
  measure_app
      ->add_option("--replicates", measure.replicates,
                   "randomisations (default 1, with --summary 64; of files: the sets)")
      ->type_name("R");
  measure_app->add_option("--seed", measure.seed, "of the random numbers")
      ->capture_default_str()
      ->type_name("S")
      ->check(whole_number());
  CLI::Option* wrap = measure_app->add_flag("--wrap", measure.wrap, "take points outside [0,1) modulo 1");
  measure_app->add_flag("--clamp", measure.clamp, "move points outside [0,1) to its nearest end")->excludes(wrap);
  measure_app->add_flag("--summary", measure.summary, "mean over replicates and its 95 % interval instead of each");
  measure_app->add_option("--exr", measure.exr, "write the mean spectrum as an image too")->type_name("FILE");
  measure_app->add_flag("--json", measure.json, "as JSON");
  measure_app->add_option("--threads", measure.threads, "threads; the results do not depend on it (default: all cores)")
      ->check(CLI::Range(1, 4096));
  measure_app->add_flag("--quiet", measure.quiet, "no progress, and not what is left out");

  RenderArguments render;
  CLI::App* render_app = app.add_subcommand("render", "render one replicate to an EXR image");
  render_app->add_option("--scene", render.scene, "catalogue name or .xml path")->required()->type_name("SCENE");
  render_app->add_option("--estimator", render.estimator, "see `halfslope list estimators` (default: balance, or mean)")
      ->type_name("NAME");
  render_app->add_option("--sampler", render.sampler, "see `halfslope list samplers`")
      ->capture_default_str()
      ->type_name("NAME");
  render_app->add_option("--samples", render.samples, "N per pixel")->capture_default_str()->type_name("N");
  render_app->add_option("--seed", render.seed, "of the random numbers")
      ->capture_default_str()
      ->type_name("S")
      ->check(whole_number());
  render_app->add_option("--replicate", render.replicate, "which randomisation")->capture_default_str()->type_name("K");
  render_app->add_option("--resolution", render.resolution, "WIDTH,HEIGHT")->type_name("W,H");
  render_app->add_option("--precision", render.precision, "f32 or f64")->capture_default_str()->type_name("P");
  render_app->add_option("--out,-o", render.out, "image file (default: SCENE.exr)")->type_name("FILE");
  render_app->add_option("--threads", render.threads, "threads (default: all cores)")->check(CLI::Range(1, 4096));
  render_app->add_flag("--quiet", render.quiet, "no progress");

  ReferenceArguments reference;
  CLI::App* reference_app =
      app.add_subcommand("reference", "print or render a scene's reference values, with standard errors");
  reference_app->add_option("--scene", reference.scene, "catalogue name or .xml path")->required()->type_name("SCENE");
  reference_app->add_option("--resolution", reference.resolution, "WIDTH,HEIGHT")->type_name("W,H");
  reference_app
      ->add_option("--samples", reference.samples,
                   "N of each replicate (default 2^19 up to 64 pixels, up to 2^28 where that is not enough, else 8192)")
      ->type_name("N");
  reference_app
      ->add_option("--relative-error", reference.relative_error,
                   "rms of the pixels' relative standard errors to reach (default 1e-5 up to 64 pixels, else 1e-3)")
      ->type_name("X");
  reference_app
      ->add_option("--max-replicates", reference.most_replicates,
                   "the most replicates to spend; an error if they do not suffice")
      ->capture_default_str()
      ->type_name("R")
      ->check(CLI::Range(16, 1 << 24));
  reference_app->add_option("--out,-o", reference.out, "write an EXR instead of CSV")->type_name("FILE");
  reference_app->add_option("--threads", reference.threads, "threads (default: all cores)")->check(CLI::Range(1, 4096));
  reference_app->add_flag("--no-cache", reference.no_cache, "neither read nor write the cache of references");
  reference_app->add_flag("--json", reference.json, "as JSON");
  reference_app->add_flag("--quiet", reference.quiet, "no progress");

  FigureArguments figure;
  CLI::App* figure_app = app.add_subcommand("figure", "draw a figure for print: PNG or SVG");
  figure_app->add_option("name", figure.name, "see `halfslope list figures`")->required()->type_name("NAME");
  figure_app->add_option("--out,-o", figure.out, "FILE.png (288 pixels an inch) or FILE.svg (default: NAME.png)")
      ->type_name("FILE");
  for (const auto& [spelling, help] : std::vector<std::pair<std::string, std::string>>{
           {"--run", "convergence, work-precision: the run folder to draw"},
           {"--scene", "veach, glossy: which scene; convergence, work-precision: only these"},
           {"--estimators,--estimator", "veach, glossy: a picture each; convergence, work-precision: only these"},
           {"--samplers,--sampler", "a picture, a panel or a line each; convergence, work-precision: only these"},
           {"--precision", "convergence, work-precision: only f32 or f64"},
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
    figure_app
        ->add_option_function<std::string>(
            spelling, [&figure, key](const std::string& value) { figure.keys[key] = value; }, help)
        ->type_name("VALUE");
  }
  figure_app->add_option("--points", figure.files, "files of points beside the --samplers, a line each")
      ->type_name("FILE");
  const auto add_switch = [&](const std::string& key, const char* help) {
    return figure_app->add_flag_callback(
        "--" + key, [&figure, key] { figure.keys[key] = ""; }, help);
  };
  add_switch("wrap", "take points of files outside [0,1) modulo 1")
      ->excludes(add_switch("clamp", "move points of files outside [0,1) to its nearest end"));
  add_switch("side-by-side", "radial-spectrum, pcf: a diagram for each sampler");
  figure_app->add_option("--threads", figure.threads, "threads; the figure does not depend on it (default: all cores)")
      ->check(CLI::Range(1, 4096));
  figure_app->add_flag("--quiet", figure.quiet, "no progress");

  SelfcheckArguments selfcheck;
  CLI::App* selfcheck_app =
      app.add_subcommand("selfcheck", "measure again what is promised: the coverage of every interval");
  selfcheck_app->add_option("what", selfcheck.what, "coverage")->required()->type_name("WHAT");
  selfcheck_app->add_option("--study,--studies", selfcheck.studies, "only these (default: all)")
      ->delimiter(',')
      ->type_name("NAME,...");
  selfcheck_app->add_option("--runs", selfcheck.runs, "simulated experiments a row (default: each study's own)")
      ->type_name("N")
      ->check(CLI::Range(10, 100'000'000));
  selfcheck_app->add_option("--seed", selfcheck.seed, "of the random numbers")
      ->capture_default_str()
      ->type_name("S")
      ->check(whole_number());
  selfcheck_app->add_option("--threads", selfcheck.threads, "threads; the table does not depend on it (default: all)")
      ->check(CLI::Range(1, 4096));
  selfcheck_app->add_flag("--json", selfcheck.json, "as JSON");
  selfcheck_app->add_flag("--quiet", selfcheck.quiet, "no progress");

  AnalyzeImagesArguments images;
  CLI::App* analyze_app = app.add_subcommand("analyze", "analyse what was made elsewhere: images");
  analyze_app->require_subcommand(1);
  CLI::App* images_app = analyze_app->add_subcommand("images", "tables of a run for EXR images of any renderer");
  images_app
      ->add_option("--pattern", images.pattern,
                   "paths with the fields {scene} {estimator} {sampler} {precision} {samples} {seed}, such as "
                   "'out/{estimator}/{sampler}/{samples}_{seed}.exr'; the seeds are the replicates")
      ->required()
      ->type_name("PATTERN");
  images_app->add_option("--reference", images.reference, "the image to measure against; may have {scene}")
      ->type_name("FILE");
  images_app
      ->add_option("--reference-halves", images.halves,
                   "two independent images of the reference's integrals, for errors that need no variance of it; "
                   "without --reference their mean is the reference")
      ->type_name("A B")
      ->expected(2);
  images_app->add_option("--layer", images.layer, "channels LAYER.R, LAYER.G, LAYER.B (or LAYER.Y) instead of R, G, B")
      ->type_name("LAYER");
  images_app->add_option("--out", images.out, "folder of the tables (default: out/images)")->type_name("DIR");
  images_app->add_option("--threads", images.threads, "threads; the results do not depend on it (default: all cores)")
      ->check(CLI::Range(1, 4096));
  images_app->add_flag("--json", images.json, "print the rows of convergence.csv as JSON instead of the summary");
  images_app->add_flag("--keep-going", images.keep_going, "exit 0 though files were missing, broken or not finite");
  images_app->add_flag("--quiet", images.quiet, "no progress, no summary");

  CLI::App* completion_app =
      app.add_subcommand("completion", "print a bash completion script: source <(halfslope completion)");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(command->get_name());
    std::string problem = error.what();
    if (argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty()) {
      problem = fmt::format("there is no command '{}'{}", argv[1], did_you_mean(argv[1], names));
    }
    message("halfslope: {}\nTry `halfslope {}--help`.\n", problem,
            app.get_subcommands().empty() ? "" : app.get_subcommands().front()->get_name() + " ");
    return static_cast<int>(ExitCode::kUsage);
  }
  if (run_app->parsed()) return run_command(run, catalogue);
  if (list_app->parsed()) {
    list.names_only = names_only;
    return list_command(list, catalogue);
  }
  if (points_app->parsed()) return points_command(points, catalogue);
  if (measure_app->parsed()) {
    for (const std::string& name : measured_samplers) measure.samplers += (measure.samplers.empty() ? "" : ",") + name;
    return measure_command(measure, catalogue);
  }
  if (render_app->parsed()) return render_command(render, catalogue);
  if (reference_app->parsed()) return reference_command(reference, catalogue);
  if (figure_app->parsed()) return figure_command(figure, catalogue);
  if (selfcheck_app->parsed()) return selfcheck_command(selfcheck);
  if (images_app->parsed()) return analyze_images_command(images);
  if (completion_app->parsed()) fmt::print("{}", bash_completion(app));
  return 0;
}

// The number of a closed standard stream would go to the next file that is opened, and text meant for the stream into
// that file. What is opened here instead refuses it, as a closed stream does.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) < 0) ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace

int command_line(int argc, const char* const* argv, const Catalogue& catalogue) {
  occupy_closed_streams();
  int code = static_cast<int>(ExitCode::kIo);
  try {
    code = parse_and_run(argc, argv, catalogue);
  } catch (const Error& error) {
    message("halfslope: {}\n", error.what());
    code = static_cast<int>(error.code());
  } catch (const std::bad_alloc&) {
    message("halfslope: out of memory; ask for fewer points, pixels or replicates\n");
  } catch (const std::exception& error) {
    message("halfslope: {}\n", error.what());
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    message("halfslope: standard output could not be written\n");
    code = code == 0 ? static_cast<int>(ExitCode::kIo) : code;
  }
  return code;
}

}  // namespace halfslope
