#include "drivers/hash.h"

#include "iga/core/text_hash.h"

namespace couture::drivers {

std::string fnv_hash(std::string_view text) { return text_hash(text); }

}  // namespace couture::drivers
