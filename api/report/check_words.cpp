#include "api/report/check_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace tunewright::api {
namespace {

using Word = std::pair<std::string_view, const char*>;

constexpr std::array<Word, 12> kVerdicts = {{{"stiction", "Sticking valve"},
                                             {"backlash", "Backlash"},
                                             {"tight", "Tuned too tight"},
                                             {"sluggish", "Tuned too slow"},
                                             {"external", "Disturbed from outside"},
                                             {"saturation", "Output at its limit"},
                                             {"quantised", "Coarse measurement"},
                                             {"manual", "In manual"},
                                             {"frozen", "Frozen measurement"},
                                             {"undetermined", "Cause not found"},
                                             {"insufficient-data", "Record not sufficient"},
                                             {"healthy", "Healthy"}}};

constexpr std::array<Word, 9> kActions = {{{"none", "nothing"},
                                           {"retune", "tune"},
                                           {"repair-valve", "repair the valve"},
                                           {"find-source", "find the source"},
                                           {"return-to-automatic", "return to automatic"},
                                           {"check-range", "look at the limit"},
                                           {"check-transmitter", "check the transmitter"},
                                           {"record-again", "record again"},
                                           {"test", "make a test"}}};

constexpr std::array<const char*, 4> kEfforts = {"none", "settings", "a test", "work on the plant"};

template <std::size_t N>
std::string word_for(const std::array<Word, N>& words, std::string_view code) {
    const auto found = std::ranges::find(words, code, &Word::first);
    return found == words.end() ? std::string(code) : found->second;
}

std::string verdict_of(const Json& loop) {
    const Json cause = loop.is_object() ? loop.value("cause", Json()) : Json();
    const Json verdict = cause.is_object() ? cause.value("verdict", Json()) : Json();
    return verdict.is_string() ? verdict.get<std::string>() : "";
}

std::string begun_small(std::string text) {
    if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
    return text;
}

}  // namespace

std::string verdict_title(std::string_view verdict) { return word_for(kVerdicts, verdict); }

std::string action_title(std::string_view action) { return word_for(kActions, action); }

std::string action_title(const Json& result, std::string_view action, const Json& rank) {
    const Json after = rank.is_object() ? rank.value("after", Json()) : Json();
    const std::string source = action == "find-source" ? tag_of_loop(result, after) : "";
    return source.empty() ? action_title(action) : "correct " + source + " first";
}

std::string owner_title(std::string_view owner) { return owner == "nobody" ? "–" : std::string(owner); }

std::string effort_title(const Json& effort) {
    const std::size_t level = effort.is_number_unsigned() ? effort.get<std::size_t>() : kEfforts.size();
    return level < kEfforts.size() ? kEfforts[level] : "–";
}

bool is_of_check(const Json& result) {
    return result.is_object() && result.contains("loops") && result["loops"].is_array() && result.contains("ranking");
}

std::vector<std::size_t> work_order(const Json& result) {
    const std::size_t count = result.at("loops").size();
    std::vector<bool> placed(count, false);
    std::vector<std::size_t> order;
    const auto place = [&](std::size_t loop) {
        if (loop >= count || placed[loop]) return;
        placed[loop] = true;
        order.push_back(loop);
    };
    for (const Json& rank : result.at("ranking"))
        if (rank.is_object() && rank.contains("loop") && rank["loop"].is_number_unsigned())
            place(rank["loop"].get<std::size_t>());
    for (std::size_t loop = 0; loop < count; ++loop) place(loop);
    return order;
}

std::vector<std::size_t> loops_with_page(const Json& result) {
    static constexpr std::array<std::string_view, 3> kNoCause = {"healthy", "undetermined", "insufficient-data"};
    constexpr std::size_t kMaxPages = 50;
    std::vector<std::size_t> order = work_order(result);
    if (order.size() <= kMaxPages) return order;
    std::erase_if(order, [&](std::size_t loop) {
        return std::ranges::find(kNoCause, verdict_of(result["loops"][loop])) != kNoCause.end();
    });
    order.resize(std::min(order.size(), kMaxPages));
    return order;
}

std::string check_summary(const Json& result) {
    const Json& loops = result.at("loops");
    std::vector<std::pair<std::string, int>> causes;
    for (const std::size_t loop : work_order(result)) {
        const std::string verdict = verdict_of(loops[loop]);
        const auto known = std::ranges::find(causes, verdict, &std::pair<std::string, int>::first);
        if (known == causes.end())
            causes.emplace_back(verdict, 1);
        else
            ++known->second;
    }
    if (causes.empty()) return "";
    std::string out = std::to_string(loops.size()) + (loops.size() == 1 ? " loop: " : " loops: ");
    for (std::size_t i = 0; i < causes.size(); ++i)
        out +=
            (i == 0 ? "" : ", ") + std::to_string(causes[i].second) + " " + begun_small(verdict_title(causes[i].first));
    return out + ".";
}

std::string tag_of_loop(const Json& result, const Json& loop) {
    const Json& loops = result.at("loops");
    if (!loop.is_number_unsigned() || loop.get<std::size_t>() >= loops.size()) return "";
    const Json& found = loops[loop.get<std::size_t>()];
    const Json tag = found.is_object() ? found.value("tag", Json()) : Json();
    return tag.is_string() ? tag.get<std::string>() : "";
}

std::string tags_of_loops(const Json& result, const Json& places) {
    std::string out;
    for (const Json& place : places) out += (out.empty() ? "" : ", ") + tag_of_loop(result, place);
    return out;
}

}  // namespace tunewright::api
