#include "api/csv/shape/shape.h"

#include <utility>

#include "api/csv/shape/shapes.h"
#include "api/csv/text.h"

namespace tunewright::api {

CsvSource::CsvSource(std::string_view bytes, const ColumnChoices& chosen) {
    file_ = text_ = utf8_text(bytes, utf8_);
    if (auto log = message_log(text_, chosen))
        take(*std::move(log));
    else if (auto rows = json_rows(text_))
        take(*std::move(rows));
    else if (auto events = event_lines(text_))
        take(*std::move(events));
    else
        layout_ = find_layout(text_, chosen);
    refuse_width();
    if (!fault_.empty() || layout_.pivoted || layout_.pairs) return;
    if (auto table = long_table(text_, layout_)) take(*std::move(table));
}

void CsvSource::take(ShapedText shaped) {
    fault_ = std::move(shaped.fault);
    fault_at_ = std::move(shaped.fault_at);
    notes_.insert(notes_.end(), shaped.notes.begin(), shaped.notes.end());
    if (!fault_.empty()) return;
    shaped_ = std::move(shaped.text);
    text_ = shaped_;
    layout_ = find_layout(text_, {});
    layout_.pivoted = shaped.pivoted;
    layout_.source_lines = std::move(shaped.lines);
}

void CsvSource::refuse_width() {
    if (layout_.width <= kMaxColumns) return;
    fault_ = too_many_columns(layout_.width);
    layout_ = {};
}

}  // namespace tunewright::api
