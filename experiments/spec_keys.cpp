#include "experiments/spec_keys.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>

#include "analysis/measures.h"
#include "core/assertion.h"
#include "estimators/path_transport.h"
#include "experiments/joined.h"
#include "experiments/stopping_keys.h"
#include "experiments/theory.h"

namespace halfslope {
namespace {

// Larger counts are a typing error: 2^48 samples of one integral take months, and products of counts must not overflow.
constexpr std::uint64_t kMaxSamples = std::uint64_t{1} << 48;
constexpr std::uint64_t kMaxReplicates = std::uint64_t{1} << 31;
constexpr std::uint64_t kMaxSide = 65536;  // a pixel's index in the full image fits 32 bits
constexpr std::uint64_t kFewestTimings = 3, kMostTimings = 10000;

struct Key {
  std::string name;
  std::string allowed;
  bool takes_list;
  void (*set)(Spec&, const Key&, const SpecValue&);
};

std::string described(const SpecItem& item) {
  if (item.kind == SpecItem::Kind::kInteger || item.kind == SpecItem::Kind::kOther) return item.text;
  return fmt::format("'{}'", item.text);
}

// A flag's place is the key already; a file's place is a position and the key is still to be named.
[[noreturn]] void refuse(const Key& key, const SpecValue& value, const std::string& place, const std::string& problem) {
  const bool flag = value.code == ExitCode::kUsage;
  fail(value.code, "{}: {}{}{} allowed: {}", place, flag ? "" : fmt::format("key '{}': ", key.name), problem,
       problem.ends_with('?') ? "" : ";", key.allowed);
}

[[noreturn]] void refuse(const Key& key, const SpecValue& value, const SpecItem& item) {
  refuse(key, value, item.place, fmt::format("found {}", described(item)));
}

const SpecItem& only_item(const Key& key, const SpecValue& value) {
  if (value.is_list) refuse(key, value, value.place, fmt::format("found a list of {}", value.items.size()));
  return value.items.front();
}

std::uint64_t integer(const Key& key, const SpecValue& value, const SpecItem& item, std::uint64_t lo,
                      std::uint64_t hi) {
  if (item.kind != SpecItem::Kind::kInteger && item.kind != SpecItem::Kind::kFlag) refuse(key, value, item);
  std::uint64_t number = 0;
  const char* end = item.text.data() + item.text.size();
  const auto [rest, error] = std::from_chars(item.text.data(), end, number);
  if (error != std::errc{} || rest != end || number < lo || number > hi) refuse(key, value, item);
  return number;
}

const std::string& text(const Key& key, const SpecValue& value, const SpecItem& item) {
  if (item.kind != SpecItem::Kind::kText && item.kind != SpecItem::Kind::kFlag) refuse(key, value, item);
  if (item.text.empty()) refuse(key, value, item.place, "found an empty name");
  return item.text;
}

template <class T>
void append_unique(const Key& key, const SpecValue& value, const SpecItem& item, std::vector<T>& list, T element) {
  if (std::find(list.begin(), list.end(), element) != list.end())
    refuse(key, value, item.place, fmt::format("{} stands there twice", described(item)));
  list.push_back(std::move(element));
}

std::vector<std::string> names(const Key& key, const SpecValue& value) {
  if (value.items.empty()) refuse(key, value, value.place, "found an empty list");
  std::vector<std::string> list;
  for (const SpecItem& item : value.items) append_unique(key, value, item, list, text(key, value, item));
  return list;
}

std::vector<std::uint64_t> counts(const Key& key, const SpecValue& value) {
  std::vector<std::uint64_t> list;
  for (const SpecItem& item : value.items)
    append_unique(key, value, item, list, integer(key, value, item, 1, kMaxSamples));
  std::sort(list.begin(), list.end());
  return list;
}

std::uint64_t power_of_two(const Key& key, const SpecValue& value, const SpecItem& item, std::string_view digits) {
  const SpecItem bound{SpecItem::Kind::kFlag, std::string(digits), item.place};
  const std::uint64_t number = integer(key, value, bound, 1, kMaxSamples);
  if (!std::has_single_bit(number))
    refuse(key, value, item.place,
           fmt::format("found {}, and {} is not a power of two: the nearest are {} and {}", described(item), number,
                       std::bit_floor(number), std::bit_ceil(number)));
  return number;
}

void set_name(Spec& spec, const Key& key, const SpecValue& value) {
  const SpecItem& item = only_item(key, value);
  const std::string& name = text(key, value, item);
  const auto unfit = [](char c) { return c == '/' || static_cast<unsigned char>(c) < ' '; };
  if (name == "." || name == ".." || std::any_of(name.begin(), name.end(), unfit)) refuse(key, value, item);
  spec.name = name;
}

void set_samples(Spec& spec, const Key& key, const SpecValue& value) {
  if (value.items.empty()) refuse(key, value, value.place, "found an empty list");
  const SpecItem& first = value.items.front();
  const bool may_be_range = first.kind == SpecItem::Kind::kText || first.kind == SpecItem::Kind::kFlag;
  const std::size_t colon = first.text.find(':');
  if (value.is_list || !may_be_range || colon == std::string::npos) {
    spec.samples = {counts(key, value), false};
    return;
  }
  const std::string_view range = first.text;
  const std::uint64_t lo = power_of_two(key, value, first, range.substr(0, colon));
  const std::uint64_t hi = power_of_two(key, value, first, range.substr(colon + 1));
  if (lo > hi) refuse(key, value, first.place, fmt::format("found {}, which ends before it begins", described(first)));
  spec.samples = {{}, true};
  for (std::uint64_t count = lo; count <= hi; count *= 2) spec.samples.counts.push_back(count);
}

void set_resolution(Spec& spec, const Key& key, const SpecValue& value) {
  if (!value.is_list) refuse(key, value, value.items.front());
  if (value.items.size() != 2) refuse(key, value, value.place, fmt::format("found a list of {}", value.items.size()));
  spec.resolution = {static_cast<int>(integer(key, value, value.items[0], 1, kMaxSide)),
                     static_cast<int>(integer(key, value, value.items[1], 1, kMaxSide))};
}

void set_pixels(Spec& spec, const Key& key, const SpecValue& value) {
  const SpecItem& item = only_item(key, value);
  const bool all = item.text == "all" && item.kind != SpecItem::Kind::kOther;
  spec.pixels.reset();
  if (!all) spec.pixels = static_cast<std::int64_t>(integer(key, value, item, 1, kMaxSide * kMaxSide));
}

void set_images(Spec& spec, const Key& key, const SpecValue& value) {
  const bool none = value.items.size() == 1 && value.items[0].text == "none" && !value.is_list;
  spec.images = none ? std::vector<std::uint64_t>{} : counts(key, value);
}

void set_precision(Spec& spec, const Key& key, const SpecValue& value) {
  if (value.items.empty()) refuse(key, value, value.place, "found an empty list");
  std::vector<Precision> list;
  for (const SpecItem& item : value.items) {
    const std::string& name = text(key, value, item);
    if (name != "f32" && name != "f64") refuse(key, value, item);
    append_unique(key, value, item, list, name == "f32" ? Precision::kF32 : Precision::kF64);
  }
  spec.precision = std::move(list);
}

// They come out in the catalogue's order, so that the same measures are the same experiment.
void set_measures(Spec& spec, const Key& key, const SpecValue& value) {
  if (value.items.empty()) refuse(key, value, value.place, "found an empty list");
  std::vector<std::string> list;
  if (value.is_list || value.items[0].text != "none") {
    for (const SpecItem& item : value.items) {
      const std::string& name = text(key, value, item);
      if (name == "none") refuse(key, value, item.place, "'none' stands in a list; it stands alone, as a text");
      try {
        make_measure(name);
      } catch (const Error& error) {
        // Of a parameter the message says already what is allowed.
        if (measure_rank(name) == measure_names().size()) refuse(key, value, item.place, error.what());
        const bool flag = value.code == ExitCode::kUsage;
        fail(value.code, "{}: {}{}", item.place, flag ? "" : "key 'measures': ", error.what());
      }
      append_unique(key, value, item, list, name);
    }
  }
  std::ranges::stable_sort(list, {}, measure_rank);
  spec.measures = std::move(list);
}

void set_interval(Spec& spec, const Key& key, const SpecValue& value) {
  const SpecItem& item = only_item(key, value);
  const auto method = parse_interval_method(text(key, value, item));
  if (!method) refuse(key, value, item);
  spec.interval = *method;
}

std::vector<std::string> interval_names() {
  std::vector<std::string> names;
  for (const IntervalMethodInfo& info : interval_methods()) names.emplace_back(info.name);
  return names;
}

// 'none' takes back what the file says.
void set_quantity(std::optional<double>& field, const Key& key, const SpecValue& value,
                  std::optional<double> (*parse)(std::string_view)) {
  const SpecItem& item = only_item(key, value);
  const std::string& written = text(key, value, item);
  field = written == "none" ? std::nullopt : parse(written);
  if (!field && written != "none") refuse(key, value, item);
}

void set_timing(Spec& spec, const Key& key, const SpecValue& value) {
  const SpecItem& item = only_item(key, value);
  const bool none = item.text == "none" && item.kind != SpecItem::Kind::kOther;
  spec.timing = none ? 0 : static_cast<int>(integer(key, value, item, kFewestTimings, kMostTimings));
}

std::size_t check_rank(const std::string& name) {
  const auto found = std::ranges::find(theory_checks(), std::string_view(name), &TheoryCheckInfo::name);
  return static_cast<std::size_t>(found - theory_checks().begin());
}

std::vector<std::string> theory_check_names() {
  std::vector<std::string> list;
  for (const TheoryCheckInfo& check : theory_checks()) list.emplace_back(check.name);
  return list;
}

void set_checks(Spec& spec, const Key& key, const SpecValue& value) {
  if (value.items.empty()) refuse(key, value, value.place, "found an empty list");
  std::vector<std::string> list;
  if (value.is_list || value.items[0].text != "none") {
    for (const SpecItem& item : value.items) {
      const std::string& name = text(key, value, item);
      if (check_rank(name) == theory_checks().size())
        refuse(key, value, item.place,
               fmt::format("found {}{}", described(item), did_you_mean(name, theory_check_names())));
      append_unique(key, value, item, list, name);
    }
  }
  std::ranges::stable_sort(list, {}, check_rank);
  spec.checks = std::move(list);
}

// Of two names equally near to a wrong one, the first is offered. To add a key: a row here, a field in Spec, and its
// part in canonical_json.
const std::vector<Key>& keys() {
  static const std::vector<Key> table = {
      {"name", "a string that can name a folder", false, set_name},
      {"scene", "a scene's name, the path of a Mitsuba .xml, or a list of them", true,
       [](Spec& spec, const Key& key, const SpecValue& value) { spec.scenes = names(key, value); }},
      {"estimators", "a name or a list of different names", true,
       [](Spec& spec, const Key& key, const SpecValue& value) { spec.estimators = names(key, value); }},
      {"samples", "a range of powers of two such as 4:1024, or one or several different counts from 1 to 2^48", true,
       set_samples},
      {"samplers", "a name or a list of different names", true,
       [](Spec& spec, const Key& key, const SpecValue& value) { spec.samplers = names(key, value); }},
      {"replicates", "an integer from 1 to 2^31", false,
       [](Spec& spec, const Key& key, const SpecValue& value) {
         spec.replicates = static_cast<std::int64_t>(integer(key, value, only_item(key, value), 1, kMaxReplicates));
         spec.most_replicates = spec.replicates;
       }},
      {"seed", "an integer from 0 to 2^64 - 1 (2^63 - 1 in a file)", false,
       [](Spec& spec, const Key& key, const SpecValue& value) {
         spec.seed = integer(key, value, only_item(key, value), 0, std::numeric_limits<std::uint64_t>::max());
       }},
      {"resolution", "two integers from 1 to 65536, width and height", true, set_resolution},
      {"pixels", "'all' or an integer from 1 to 2^32", false, set_pixels},
      {"images", "one or several different counts that are among the samples, or 'none'", true, set_images},
      {"precision", "f32, f64, or a list of both", true, set_precision},
      {"measures", fmt::format("{}, a list of different ones, or 'none'", joined(measure_names())), true, set_measures},
      {"interval", joined(interval_names()), false, set_interval},
      {"target", "'rmse ±5%' with a number above 0 and below 100, or 'none'", false,
       [](Spec& spec, const Key& key, const SpecValue& value) { set_quantity(spec.target, key, value, parse_target); }},
      {"budget", "a time above 0 as in '60 s', '2 min' or '1 h', at most 1000 h, or 'none'", false,
       [](Spec& spec, const Key& key, const SpecValue& value) { set_quantity(spec.budget, key, value, parse_budget); }},
      {"timing", "an integer from 3 to 10000, the repetitions, or 'none'", false, set_timing},
      {"max_depth", fmt::format("an integer from 1 to {}: 1 sees emitters, 2 light that is scattered once", kMostDepth),
       false,
       [](Spec& spec, const Key& key, const SpecValue& value) {
         spec.max_depth = static_cast<int>(integer(key, value, only_item(key, value), 1, kMostDepth));
       }},
      {"russian_roulette",
       fmt::format("'none', or the depth from which it ends paths, an integer from 1 to {}", kMostDepth), false,
       [](Spec& spec, const Key& key, const SpecValue& value) {
         const SpecItem& item = only_item(key, value);
         const bool none = item.text == "none" && item.kind != SpecItem::Kind::kOther;
         spec.russian_roulette = none ? 0 : static_cast<int>(integer(key, value, item, 1, kMostDepth));
       }},
      {"checks", fmt::format("{}, a list of different ones, or 'none'", joined(theory_check_names())), true,
       set_checks},
  };
  return table;
}

const Key& find_key(std::string_view name) {
  const auto found = std::find_if(keys().begin(), keys().end(), [&](const Key& key) { return key.name == name; });
  assert_equal(found != keys().end(), true, fmt::format("'{}' is a key", name));
  return *found;
}

}  // namespace

std::span<const std::string> spec_key_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Key& key : keys()) list.push_back(key.name);
    return list;
  }();
  return names;
}

std::string spec_key_hint(std::string_view unknown) {
  const std::string nearest = did_you_mean(unknown, spec_key_names());
  return fmt::format("{} allowed: {}", nearest.empty() ? ";" : nearest, joined(spec_key_names()));
}

bool spec_key_takes_list(std::string_view key) { return find_key(key).takes_list; }

void set_spec_key(Spec& spec, std::string_view name, const SpecValue& value) {
  const Key& key = find_key(name);
  key.set(spec, key, value);
  spec.places[key.name] = value.place;
  spec.codes[key.name] = static_cast<int>(value.code);
}

}  // namespace halfslope
