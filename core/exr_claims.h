// Whether an OpenEXR file can hold what its header claims, asked before anything is allocated for the claim.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <cstdint>
#include <string_view>

namespace halfslope {

/// Throws an exception with the reason if an attribute of the header claims more bytes than the file has: OpenEXR
/// allocates them before it reads them. `bytes` is the whole file, its magic and version known to be good.
void check_attribute_sizes(std::string_view bytes);

/// Throws an exception with the reason if the header claims no pixels, more than 2²⁸ values, or more than `file_bytes`
/// can hold. Each chunk (a block of scan lines or a tile) has an entry of 8 bytes in the table of offsets and a head,
/// and no compression of OpenEXR shrinks data beyond a known ratio: 1032 for deflate (258 bytes in two bits), 64 for
/// run lengths, and so on, see the table in exr_claims.cpp. No finished file fails.
///
/// The buffer of one chunk is judged by that ratio too, beyond 64 MiB that it may always have; a finished file fails
/// that only if its few lines are some 100 000 equal pixels wide.
void check_claims(const Imf::Header& header, std::uint64_t file_bytes);

}  // namespace halfslope
