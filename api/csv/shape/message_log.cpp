#include "api/csv/shape/shapes.h"

#include <algorithm>
#include <string>
#include <vector>

#include "api/csv/cell.h"
#include "api/csv/table.h"
#include "api/csv/text.h"
#include "api/describe/suggest.h"

namespace tunewright::api {
namespace {

struct MessageKind {
    std::string name;
    std::vector<std::string> columns;
    int rows = 0;
    bool taken = false;
};

constexpr std::size_t kDefinedFrom = 5, kNamed = 3;  // cells of an FMT line
constexpr int kFewRows = 8;

class MessageLog {
public:
    explicit MessageLog(std::string_view text) : text_(text) {
        each_line([&](const std::vector<std::string_view>& cells, int) {
            if (cells.front() == "FMT") return define(cells);
            if (MessageKind* kind = kind_of(cells.front())) ++kind->rows;
        });
        std::erase_if(kinds_, [](const MessageKind& kind) {
            return kind.rows < kFewRows || kind.columns.size() < 2 || !is_time(kind.columns.front());
        });
    }

    bool empty() const { return kinds_.empty(); }

    ShapedText table(const ColumnChoices& chosen) {
        ShapedText out;
        for (const auto* choice : {&chosen.u, &chosen.y, &chosen.r}) {
            if (!*choice || !std::holds_alternative<std::string>(**choice)) continue;
            const auto& name = std::get<std::string>(**choice);
            chosen_names_.push_back(name);
            const auto owners = owners_of(name);
            if (owners.size() == 1) owners.front()->taken = true;
            if (owners.size() == 1) continue;
            out.fault = "\"" + name + "\" is " + (owners.empty() ? "in no kind" : "in several kinds") +
                        " of the log's messages. Name the column with its kind, such as " + example() + ". " +
                        listed_kinds();
            return out;
        }
        if (!chosen.u && !chosen.y && kinds_.size() == 1) kinds_.front().taken = true;
        if (std::ranges::none_of(kinds_, &MessageKind::taken)) {
            out.fault =
                "csv is a log of messages of several kinds. Choose the columns of u and y with their kind, such as " +
                example() + ". " + listed_kinds();
            return out;
        }
        return rows_of_taken();
    }

private:
    static bool is_time(std::string_view name) { return name.starts_with("Time"); }

    template <class Use>
    void each_line(const Use& use) const {
        std::vector<std::string_view> cells;
        std::deque<std::string> storage;
        std::size_t at = 0;
        for (int number = 1;; ++number) {
            const auto line = next_line(text_, at);
            if (!line) return;
            split_line(*line, ',', cells, storage);
            if (!cells.empty()) use(cells, number);
            storage.clear();
        }
    }

    MessageKind* kind_of(std::string_view name) {
        const auto found = std::ranges::find(kinds_, name, &MessageKind::name);
        return found == kinds_.end() ? nullptr : &*found;
    }

    void define(const std::vector<std::string_view>& cells) {
        if (cells.size() <= kDefinedFrom || cells[kNamed] == "FMT" || kind_of(cells[kNamed])) return;
        MessageKind kind{std::string(cells[kNamed]), {}};
        for (std::size_t i = kDefinedFrom; i < cells.size(); ++i) kind.columns.emplace_back(cells[i]);
        kinds_.push_back(std::move(kind));
    }

    std::vector<MessageKind*> owners_of(const std::string& name) {
        std::vector<MessageKind*> found;
        for (MessageKind& kind : kinds_)
            for (const std::string& column : kind.columns)
                if (name == column || name == kind.name + "." + column) found.push_back(&kind);
        return found;
    }

    std::string example() const {
        const MessageKind& kind = kinds_.front();
        return kind.name + "." + kind.columns.back();
    }

    std::string listed_kinds() const {
        constexpr std::size_t kShown = 12;
        std::string out = "Kinds:";
        for (std::size_t i = 0; i < std::min(kinds_.size(), kShown); ++i)
            out += (i > 0 ? "; " : " ") + kinds_[i].name + " (" + listed(kinds_[i].columns, "and") + ")";
        return out + (kinds_.size() > kShown ? "; and " + std::to_string(kinds_.size() - kShown) + " more." : ".");
    }

    /// "RATE.ROut", or "ROut" where it was chosen so.
    std::string heading_of_column(const MessageKind& kind, std::size_t i) const {
        const bool bare = std::ranges::find(chosen_names_, kind.columns[i]) != chosen_names_.end();
        return bare ? kind.columns[i] : kind.name + "." + kind.columns[i];
    }

    /// The time is the kinds' common clock.
    ShapedText rows_of_taken() {
        const bool alone = std::ranges::count(kinds_, true, &MessageKind::taken) == 1;
        std::vector<std::string> headings = {kinds_.front().columns.front()};
        std::vector<std::size_t> from;
        for (const MessageKind& kind : kinds_) {
            from.push_back(headings.size());
            if (!kind.taken) continue;
            headings.front() = kind.columns.front();
            for (std::size_t i = 1; i < kind.columns.size(); ++i) headings.push_back(heading_of_column(kind, i));
        }
        ShapedText out;
        out.pivoted = !alone;
        add_line(out, {headings.begin(), headings.end()}, 1);
        std::vector<std::string_view> row;
        each_line([&](const std::vector<std::string_view>& cells, int number) {
            const MessageKind* kind = kind_of(cells.front());
            if (kind == nullptr || !kind->taken || cells.size() < 2) return;
            row.assign(headings.size(), {});
            row[0] = cells[1];
            const std::size_t at = from[static_cast<std::size_t>(kind - kinds_.data())];
            for (std::size_t i = 2; i < std::min(cells.size(), kind->columns.size() + 1); ++i)
                row[at + i - 2] = cells[i];
            add_line(out, row, number);
        });
        std::vector<std::string> taken;
        for (const MessageKind& kind : kinds_)
            if (kind.taken) taken.push_back(kind.name);
        out.notes.push_back("The file is a log of messages; those of kind " + listed(taken, "and") + " are read.");
        return out;
    }

    std::string_view text_;
    std::vector<MessageKind> kinds_;
    std::vector<std::string> chosen_names_;
};

}  // namespace

std::optional<ShapedText> message_log(std::string_view text, const ColumnChoices& chosen) {
    constexpr int kLooked = 50;
    std::size_t at = 0;
    bool defines = false;
    for (int n = 0; n < kLooked && !defines; ++n) {
        const auto line = next_line(text, at);
        if (!line) break;
        defines = line->starts_with("FMT,");
    }
    if (!defines) return std::nullopt;
    MessageLog log(text);
    if (log.empty()) return std::nullopt;
    return log.table(chosen);
}

}  // namespace tunewright::api
