// SPDX-License-Identifier: GPL-3.0-or-later
#include "page_blocks.h"

#include <fstream>
#include <iterator>
#include <span>

#include "page/base64.h"

namespace eigencrust::bench {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Breaks at blanks, 120 characters at most.
std::string wrapped(const std::string& text) {
  constexpr std::size_t width = 120;
  std::string lines, line;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (!line.empty() && line.size() + 1 + end - begin > width) {
      lines += line + "\n";
      line.clear();
    }
    if (!line.empty()) line += ' ';
    line.append(text, begin, end - begin);
    begin = end + 1;
  }
  return lines + line + "\n";
}

struct Markdown {
  fs::path folder;
  std::string text;

  void operator()(const Heading& h) {
    text += std::string(static_cast<std::size_t>(h.level), '#') + " " + h.text + "\n\n";
  }
  void operator()(const Paragraph& p) { text += wrapped(p.text) + "\n"; }
  void operator()(const PageTable& t) {
    row(t.head);
    text += "|";
    for (std::size_t i = 0; i < t.head.size(); ++i) text += i == 0 ? "---|" : "---:|";
    text += "\n";
    for (const auto& cells : t.rows) row(cells);
    text += "\n";
  }
  void operator()(const Pictures& p) {
    if (folder.empty() || !p.in_markdown) return;
    fs::create_directories(folder);
    for (const auto& [file, caption] : p.pictures) {
      const std::string name = p.prefix + file.filename().string();
      fs::copy_file(file, folder / name, fs::copy_options::overwrite_existing);
      text += "![" + caption + "](" + folder.filename().string() + "/" + name + ")\n\n" + wrapped("*" + caption + "*") +
              "\n";
    }
  }

 private:
  void row(const std::vector<std::string>& cells) {
    text += "|";
    for (const std::string& cell : cells) {
      text += " ";
      for (const char c : cell) text += c == '|' ? std::string("\\|") : std::string(1, c == '\n' ? ' ' : c);
      text += " |";
    }
    text += "\n";
  }
};

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text)
    safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return safe;
}

/// The marks of a text as tags.
std::string marked_up(const std::string& text) {
  std::string html;
  bool strong = false, emphasis = false, code = false;
  const std::string safe = escaped(text);
  const auto turn = [&](bool& on, const std::string& tag) {
    html.append(on ? "</" : "<").append(tag).append(">");
    on = !on;
  };
  for (std::size_t i = 0; i < safe.size(); ++i) {
    if (safe[i] == '`') {
      turn(code, "code");
    } else if (!code && safe.compare(i, 2, "**") == 0) {
      turn(strong, "strong");
      ++i;
    } else if (!code && safe[i] == '*') {
      turn(emphasis, "em");
    } else {
      html += safe[i];
    }
  }
  return html;
}

struct Html {
  std::string text;

  void operator()(const Heading& h) {
    std::string tag = "h1>";
    tag[1] = static_cast<char>('0' + h.level);
    text.append("<").append(tag).append(marked_up(h.text)).append("</").append(tag).append("\n");
  }
  void operator()(const Paragraph& p) { text += "<p>" + marked_up(p.text) + "</p>\n"; }
  void operator()(const PageTable& t) {
    text += "<div class=\"wide\"><table><thead>";
    row(t.head, "th");
    text += "</thead><tbody>";
    for (const auto& cells : t.rows) row(cells, "td");
    text += "</tbody></table></div>\n";
  }
  void operator()(const Pictures& p) {
    text += p.in_markdown ? "<div class=\"pictures\">" : "<div class=\"pictures small\">";
    for (const auto& [file, caption] : p.pictures) {
      const std::string content = content_of(file);
      text += "<figure>";
      if (file.extension() == ".svg")
        text += content;
      else
        text += "<img loading=\"lazy\" alt=\"" + escaped(caption) + "\" src=\"data:image/png;base64," +
                base64(std::as_bytes(std::span(content))) + "\">";
      text += "<figcaption>" + marked_up(caption) + "</figcaption></figure>";
    }
    text += "</div>\n";
  }

 private:
  void row(const std::vector<std::string>& cells, const std::string& tag) {
    text += cells.front().starts_with("★") ? "<tr class=\"marked\">" : "<tr>";
    for (const std::string& cell : cells)
      text.append("<").append(tag).append(">").append(marked_up(cell)).append("</").append(tag).append(">");
    text += "</tr>\n";
  }
};

constexpr const char* style =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:1500px;margin:2em auto;padding:0 1em;color:#222;background:#fff}"
    "p{max-width:1000px}.wide{overflow-x:auto}table{border-collapse:collapse;font-size:13px;margin:.5em 0}"
    "th,td{padding:.2em .6em;text-align:right;border-bottom:1px solid #ddd;white-space:nowrap}"
    "th:first-child,td:first-child{text-align:left}thead th{border-bottom:2px solid "
    "#888;white-space:normal;vertical-align:bottom}"
    "tr.marked "
    "td:first-child{color:#a50}.pictures{display:flex;flex-wrap:wrap;gap:8px}figure{margin:0;max-width:100%}.small "
    "figure{width:200px}"
    "figure img{max-width:100%;height:auto;display:block}figcaption{font-size:12px;color:#555;text-align:center}"
    "code{background:#f3f3f3;padding:0 .2em}";

} // namespace

std::string blocks_as_markdown(const Blocks& blocks, const fs::path& pictures) {
  Markdown markdown{pictures, {}};
  for (const auto& block : blocks) std::visit(markdown, block);
  while (markdown.text.ends_with("\n\n")) markdown.text.pop_back();
  return markdown.text;
}

std::string blocks_as_html(const Blocks& blocks, const std::string& title) {
  Html html;
  for (const auto& block : blocks) std::visit(html, block);
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width, initial-scale=1\"><title>" +
         escaped(title) + "</title><style>" + style + "</style></head><body>\n" + html.text + "</body></html>\n";
}

} // namespace eigencrust::bench
