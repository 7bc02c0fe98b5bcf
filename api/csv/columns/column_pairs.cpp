#include "api/csv/columns/column_pairs.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tunewright::api {
namespace {

bool is_estimation(const std::string& word) {
    return word == "est" || word == "train" || word == "estimation" || word == "training" || word == "id" ||
           word == "ident" || word == "identification";
}

bool is_data_set(const std::string& word) {
    return is_estimation(word) || word == "val" || word == "test" || word == "validation" || word == "valid";
}

struct DataSet {
    std::string name;
    std::optional<std::size_t> u, y;
};

std::vector<DataSet> data_sets(const ColumnFacts& facts) {
    std::vector<DataSet> sets;
    for (std::size_t i = 0; i < facts.size(); ++i) {
        const auto& words = facts.heading(i).words;
        if (words.size() != 2 || (words[0] != "u" && words[0] != "y") || !is_data_set(words[1])) continue;
        auto set = std::find_if(sets.begin(), sets.end(), [&](const DataSet& known) { return known.name == words[1]; });
        if (set == sets.end()) set = sets.insert(set, {words[1], {}, {}});
        (words[0] == "u" ? set->u : set->y) = i;
    }
    std::erase_if(sets, [](const DataSet& set) { return !set.u || !set.y; });
    return sets;
}

/// True if another column has exactly a name of y: input and output then have another meaning.
bool has_plain_output(const ColumnFacts& facts, std::size_t input, std::size_t output) {
    for (std::size_t i = 0; i < facts.size(); ++i) {
        if (i == input || i == output || !facts.holds_numbers(i) || is_auxiliary(facts.heading(i))) continue;
        const auto plain = match(facts.heading(i), kOutputRole);
        if (plain && plain->level == 1) return true;
    }
    return false;
}

}  // namespace

std::optional<NamedPair> fold_umlauts(const ColumnFacts& facts) {
    std::array<std::optional<std::size_t>, 3> letters;
    for (std::size_t i = 0; i < facts.size(); ++i) {
        const std::string& name = facts.heading(i).name;
        if (name == "u" || name == "pv") return std::nullopt;
        if (name == "w" || name == "x" || name == "y") letters[static_cast<std::size_t>(name[0] - 'w')] = i;
    }
    if (!letters[0] || !letters[1] || !letters[2]) return std::nullopt;
    const std::string why = " (w, x and y stand for set point, measurement and controller output, as in DIN 19226)";
    return NamedPair{*letters[2], *letters[1], why, why};
}

std::optional<NamedPair> data_set(const ColumnFacts& facts) {
    const std::vector<DataSet> sets = data_sets(facts);
    if (sets.empty()) return std::nullopt;
    const auto first =
        std::find_if(sets.begin(), sets.end(), [](const DataSet& set) { return is_estimation(set.name); });
    const DataSet& taken = first == sets.end() ? sets.front() : *first;
    NamedPair pair{*taken.u, *taken.y};
    for (const DataSet& set : sets) {
        if (&set == &taken) continue;
        pair.note = "The file holds a second pair, " + facts.shown(*set.u) + " and " + facts.shown(*set.y) +
                    "; choose its columns to use that one.";
    }
    return pair;
}

std::variant<std::monostate, NamedPair, std::string> input_with_output(const ColumnFacts& facts,
                                                                       const std::function<bool(std::size_t)>& free) {
    std::optional<std::size_t> input, output;
    bool reference = false;
    for (std::size_t i = 0; i < facts.size(); ++i) {
        const auto& words = facts.heading(i).words;
        reference = reference || match(facts.heading(i), kReferenceRole);
        if (words.empty() || !free(i) || facts.profile(i).numbers == 0) continue;
        if (words.back() == "input" || words.back() == "entrada") input = i;
        if (words.back() == "output" || words.back() == "salida") output = i;
    }
    if (!input || !output || stem(facts.heading(*input)) != stem(facts.heading(*output))) return {};
    if (has_plain_output(facts, *input, *output)) return {};
    if (reference) {
        const std::string why = " (in the controller's words, because the file has a set point)";
        return NamedPair{*output, *input, why, why};
    }
    const std::string levels = " (it stays on its levels)", moves = " (it moves)";
    if (facts.held(*output, *input)) return NamedPair{*output, *input, levels, moves};
    if (facts.held(*input, *output)) return NamedPair{*input, *output, levels, moves};
    return facts.shown(*input) + " and " + facts.shown(*output) +
           " may be those of the plant or of the controller, and the numbers do not show which. Choose the column of "
           "u, the "
           "controller output, and that of y, the measurement.";
}

}  // namespace tunewright::api
