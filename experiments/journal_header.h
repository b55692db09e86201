// The first two lines of a journal.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "experiments/journal.h"

namespace halfslope {

/// Magic and JSON, each a line.
std::string journal_preamble(const JournalHeader& header);

/// How a file begins that may be a journal.
struct JournalStart {
  enum class Kind {
    kUnborn,   ///< empty, or cut before its header was complete: nothing was stored yet
    kForeign,  ///< not a journal of this format
    kJournal,
  } kind;
  JournalHeader header;    ///< where kJournal
  std::size_t length = 0;  ///< bytes of the preamble, where kJournal
};
JournalStart read_journal_start(std::string_view beginning);

/// What differs, for a message: "spec (0123… there, 4567… here), version (…)"; empty if nothing does.
std::string header_difference(const JournalHeader& there, const JournalHeader& here);

}  // namespace halfslope
