// What changes of batches have in common in every store: the size of their slices, and what they find.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "server/store/store.h"

namespace tunewright::server {

/// Entries that one slice of a change touches: some milliseconds of the one thread that writes, so that other changes
/// never wait longer for a large batch.
constexpr std::size_t kSlice = 250;

/// The end of a batch's upload. `leaving` is the seq of the batch that has to be deleted: the one that was sent, where
/// the answer is `existing` or `conflict`.
struct SealedBatch {
    Sealed answer;
    std::optional<std::int64_t> leaving;
};

/// What JobStore::remove_batch() found. `leaving` is the seq of the batch that has to be deleted, where the effect is
/// `removed`.
struct RemovedBatch {
    RemoveEffect effect = RemoveEffect::none;
    std::int64_t leaving = 0;
};

}  // namespace tunewright::server
