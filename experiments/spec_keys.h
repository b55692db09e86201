// The keys of an experiment: how a value, from a file or from a flag, becomes a field of the Spec.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "experiments/spec.h"

namespace halfslope {

/// One value before it is understood.
struct SpecItem {
  enum class Kind : std::uint8_t {
    kText,     ///< a string of the file
    kInteger,  ///< an integer of the file, in decimal
    kFlag,     ///< a flag's text: a string or an integer, as the key likes it
    kOther,    ///< anything else; `text` says what, e.g. "a boolean"
  } kind;
  std::string text;
  std::string place;  ///< "file.toml:3:9" or "--samplers"
};

/// What a key was set to.
struct SpecValue {
  std::vector<SpecItem> items;
  bool is_list = false;
  std::string place;
  ExitCode code = ExitCode::kBadInput;
};

/// Every key, in the order of the documentation.
std::span<const std::string> spec_key_names();

/// The tail of an error about an unknown key: "; did you mean 'samples'? allowed: name, scene, …".
std::string spec_key_hint(std::string_view unknown);

/// Whether the key takes a list, so that a flag's commas separate its items.
bool spec_key_takes_list(std::string_view key);

/// Sets one of spec_key_names(); the error names the value's place, what was found and what is allowed.
void set_spec_key(Spec& spec, std::string_view key, const SpecValue& value);

}  // namespace halfslope
