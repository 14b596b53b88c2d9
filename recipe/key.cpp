#include "recipe/key.h"

#include <bit>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <link.h>

namespace pith {
namespace {

std::uint64_t final_mix(std::uint64_t k) {
  k = (k ^ (k >> 33)) * 0xff51afd7ed558ccdull;
  k = (k ^ (k >> 33)) * 0xc4ceb9fe1a85ec53ull;
  return k ^ (k >> 33);
}

void append_word(std::string& bytes, char kind, std::uint64_t word) {
  char buffer[9] = {kind};
  std::memcpy(buffer + 1, &word, 8);
  bytes.append(buffer, 9);
}

} // namespace

std::string Key::text() const {
  static constexpr char digit[] = "0123456789abcdef";
  std::string result(32, '0');
  for (int i = 0; i < 16; ++i) {
    result[15 - i] = digit[(high >> (4 * i)) & 15];
    result[31 - i] = digit[(low >> (4 * i)) & 15];
  }
  return result;
}

Key key_from(std::string_view text) {
  Key key;
  if (text.size() != 32) return key;
  const auto read = [](std::string_view digits, std::uint64_t& into) {
    return std::from_chars(digits.data(), digits.data() + 16, into, 16).ptr == digits.data() + 16;
  };
  return read(text.substr(0, 16), key.high) && read(text.substr(16), key.low) ? key : Key{};
}

Key key_of(std::string_view bytes, std::uint64_t seed) {
  constexpr std::uint64_t c1 = 0x87c37b91114253d5ull, c2 = 0x4cf5ad432745937full;
  std::uint64_t h1 = seed, h2 = seed;
  const std::size_t blocks = bytes.size() / 16;
  for (std::size_t i = 0; i < blocks; ++i) {
    std::uint64_t k1, k2;
    std::memcpy(&k1, bytes.data() + 16 * i, 8);
    std::memcpy(&k2, bytes.data() + 16 * i + 8, 8);
    h1 ^= std::rotl(k1 * c1, 31) * c2;
    h1 = (std::rotl(h1, 27) + h2) * 5 + 0x52dce729;
    h2 ^= std::rotl(k2 * c2, 33) * c1;
    h2 = (std::rotl(h2, 31) + h1) * 5 + 0x38495ab5;
  }
  std::uint64_t tail[2] = {0, 0};
  const std::size_t rest = bytes.size() - 16 * blocks;
  if (rest > 0) std::memcpy(tail, bytes.data() + 16 * blocks, rest);
  h2 ^= std::rotl(tail[1] * c2, 33) * c1;
  h1 ^= std::rotl(tail[0] * c1, 31) * c2;
  h1 ^= bytes.size();
  h2 ^= bytes.size();
  h1 += h2;
  h2 += h1;
  h1 = final_mix(h1);
  h2 = final_mix(h2);
  h1 += h2;
  h2 += h1;
  return {h1, h2};
}

KeyMaker& KeyMaker::add(std::string_view text) {
  append_word(bytes_, 't', text.size());
  bytes_.append(text);
  return *this;
}

KeyMaker& KeyMaker::add(const Key& key) {
  append_word(bytes_, 'k', key.high);
  append_word(bytes_, 'k', key.low);
  return *this;
}

KeyMaker& KeyMaker::add(double number) {
  append_word(bytes_, 'd', std::bit_cast<std::uint64_t>(number));
  return *this;
}

KeyMaker& KeyMaker::add(std::uint64_t number) {
  append_word(bytes_, 'u', number);
  return *this;
}

std::string code_version() {
  std::string id;
  // The first object that is listed is the program itself.
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* into) {
        for (int i = 0; i < info->dlpi_phnum; ++i) {
          const auto& header = info->dlpi_phdr[i];
          if (header.p_type != PT_NOTE) continue;
          const auto* at = reinterpret_cast<const char*>(info->dlpi_addr + header.p_vaddr);
          const char* const end = at + header.p_memsz;
          while (at + sizeof(ElfW(Nhdr)) <= end) {
            ElfW(Nhdr) note;
            std::memcpy(&note, at, sizeof note);
            const char* name = at + sizeof note;
            const char* content = name + ((note.n_namesz + 3u) & ~3u);
            if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 && std::memcmp(name, "GNU", 4) == 0) {
              static_cast<std::string*>(into)->assign(content, note.n_descsz);
              return 1;
            }
            at = content + ((note.n_descsz + 3u) & ~3u);
          }
        }
        return 1;
      },
      &id);
  if (!id.empty()) return key_of(id).text();
  std::ifstream program("/proc/self/exe", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(program), std::istreambuf_iterator<char>()};
  return key_of(bytes).text();
}

} // namespace pith
