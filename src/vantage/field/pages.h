// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

namespace vantage {

/// Asks the system to back memory that nothing has touched yet by large pages, where there are such and the block is worth it: it is then there in a
/// fraction of the time, and walks across it miss fewer translations. Changes no value.
void prefer_large_pages(void* begin, std::size_t bytes);

}  // namespace vantage
