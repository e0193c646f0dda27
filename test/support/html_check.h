// Whether a page is well-formed, and stands for itself.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace depth_fusion {

// The page without what is between the tags of scripts and styles, and without pictures.
inline std::string marksOf(const std::string& page) {
  std::string marks;
  size_t at = 0;
  while (at < page.size()) {
    const size_t script = std::min(page.find("<script", at), page.find("<style", at));
    const size_t begin = script == std::string::npos ? script : page.find('>', script) + 1;
    marks += page.substr(at, begin == std::string::npos ? begin : begin - at);
    if (begin == std::string::npos) break;
    at = page.find(page.compare(script, 7, "<script") == 0 ? "</script>" : "</style>", begin);
  }
  return marks;
}

// Every element that is opened is closed, in its turn, and its attributes stand in quotes.
inline void expectWellFormed(const std::string& page) {
  const std::set<std::string> empty = {"meta", "img", "br"};
  std::vector<std::string> open;
  const std::string marks = marksOf(page);
  for (size_t at = marks.find('<'); at != std::string::npos; at = marks.find('<', at + 1)) {
    const size_t end = marks.find('>', at);
    ASSERT_NE(end, std::string::npos) << marks.substr(at, 80);
    const std::string tag = marks.substr(at + 1, end - at - 1);
    if (tag[0] == '!') continue;
    const std::string name =
        tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" \n/", 1) - (tag[0] == '/' ? 1 : 0));
    if (tag[0] == '/') {
      ASSERT_FALSE(open.empty()) << tag;
      ASSERT_EQ(tag.substr(1), open.back()) << marks.substr(at > 200 ? at - 200 : 0, 260);
      open.pop_back();
    } else if (tag.back() != '/' && empty.count(name) == 0) {
      open.push_back(name);
    }
    ASSERT_EQ(std::count(tag.begin(), tag.end(), '"') % 2, 0) << tag.substr(0, 200);
  }
  EXPECT_TRUE(open.empty()) << open.back();
}

// Nothing of it is anywhere else.
inline void expectAlone(const std::string& page) {
  for (const std::string word :
       {"http:", "https:", "//cdn", "@import", "url(", "<link", "<iframe", "fetch(", "XMLHttpRequest"})
    EXPECT_EQ(page.find(word), std::string::npos) << word;
  for (const std::string source : {"src=\"", "href=\""}) {
    for (size_t at = page.find(source); at != std::string::npos; at = page.find(source, at + 1))
      EXPECT_EQ(page.compare(at + source.size(), 5, "data:"), 0) << page.substr(at, 60);
  }
}

}  // namespace depth_fusion
