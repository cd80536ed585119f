# To source, by the tests of wheels; fail() must be there. It looks at $library, of any processor.
# The library needs the C library alone, no newer one than its wheel may, and exports ours alone.
# $newest is the version that it needs.
others=$(readelf -dW "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' |
  grep -vE '^(ld-linux-[a-z0-9-]+|lib(c|m|dl|pthread))\.so\.' || true)
[[ -z $others ]] || fail "its library needs $others"
newest=$(readelf -VW "$library" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -1)
# Releases are built on Debian 12, whose own is 2.36.
most=GLIBC_$(getconf GNU_LIBC_VERSION | cut -d' ' -f2)
[[ $most != GLIBC_2.36 ]] || most=GLIBC_2.28
[[ $(printf '%s\n' "$newest" "$most" | sort -V | tail -1) == "$most" ]] ||
  fail "its library needs $newest"
foreign=$(readelf --dyn-syms -W "$library" | awk '$5 == "GLOBAL" && $7 != "UND" {print $8}' |
  grep -v '^qtet_' || true)
[[ -z $foreign ]] || fail "its library exports $foreign"
