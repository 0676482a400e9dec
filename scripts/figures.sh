# Sourced by report.sh: figures out of what was measured, and into the pages that show them.

# Puts what it reads between <!-- NAME --> and <!-- /NAME --> of a page: on lines of its own where the
# marker ends its line, else in the line.
put() {
    cat >"$made/figure"
    awk -v name="$1" -v figure="$made/figure" -v page="$2" '
        BEGIN { while ((getline line < figure) > 0) text = text (rows++ ? "\n" : "") line }
        { all = all $0 "\n" }
        END {
            open = "<!-- " name " -->"; shut = "<!-- /" name " -->"
            from = index(all, open); to = index(all, shut)
            if (!from || to < from) {
                print page ": there is no " open " before a " shut > "/dev/stderr"
                exit 1
            }
            from += length(open)
            gap = substr(all, from, 1) == "\n" ? "\n\n" : ""
            printf "%s%s%s%s%s", substr(all, 1, from - 1), gap, text, gap, substr(all, to)
        }' "$2" >"$made/page"
    cp "$made/page" "$2"
}

# What stands there.
figures() {
    awk -v name="$1" '
        { all = all $0 "\n" }
        END {
            open = "<!-- " name " -->"
            from = index(all, open) + length(open); to = index(all, "<!-- /" name " -->")
            if (from > length(open) && to >= from) print substr(all, from, to - from)
        }' "$2"
}

# Whether two pages have the same figures, if on the same driver: times (numbers with a point that are no
# per cent), rounds and dates aside.
same_figures() {
    committed=$made/figures-committed
    new=$made/figures-made
    times='s/| -*[0-9]*\.[0-9]* |/| ms |/g'
    runs='s/, medians of [0-9]* rounds, [0-9-]*//'
    figures "$1" "$2" | sed -e "$times" -e "$runs" >"$committed"
    figures "$1" "$3" | sed -e "$times" -e "$runs" >"$new"
    if ! grep -q '[^[:space:]]' "$committed"; then
        echo "$2: no figures between <!-- $1 --> and <!-- /$1 -->" >&2
        return 1
    fi
    driver='s/^\*\(.*\);.*/\1/p'
    if [ "$(sed -n "$driver" "$committed")" != "$(sed -n "$driver" "$new")" ]; then
        echo "$2: $1 is of another driver, and not compared" >&2
        return 0
    fi
    diff "$committed" "$new" >&2
}

thousands() {
    echo "$1" | awk '{
        for (digits = $1; length(digits) > 3; digits = substr(digits, 1, length(digits) - 3))
            rest = "," substr(digits, length(digits) - 2) rest
        print digits rest
    }'
}

duration() {
    [ "$1" -lt 60 ] || printf '%d min ' $(($1 / 60))
    echo "$(($1 % 60)) s"
}

# sweep.md in a sentence: the ends of what maps can do, beside volumes.
sweep_in_words() {
    awk -F ' *[|] *' '
        /^## All/ { rows = 1 }
        !rows || $2 !~ /^`/ { next }
        {
            count++; name = $2; time = $3; wrong = $4
            sub(/ %/, "", wrong)
            if (name == "`volume`") { volume = time; exact = wrong }
            if (name !~ /^`(cube|flat)-/) next
            if (!maps++) { fast = name; fast_wrong = wrong }
            if (maps == 1 || wrong + 0 < best + 0) { best = wrong; best_name = name; best_time = time }
        }
        END {
            printf "%d configurations. ", count
            printf "The fastest map (%s) is %.1f %% wrong; the most exact one (%s, ", fast, fast_wrong, best_name
            printf "%.2f %%) takes %.1f times as long as ", best, best_time / volume
            printf "volumes, of which %s %% of the pixels are wrong.\n", exact
        }' "$1"
}

# The lines `ratio NAME VALUE` of the benches.
ratios() {
    sed -n 's/^ratio \([^ ]*\) \(.*\)$/\1 \2/p' "$1"
}

rounded='function rounded(x) { return sprintf(x < 0.1 ? "%.2g" : x < 20 ? "%.2f" : "%.0f", x) }'

value() {
    awk -v name="$1" "$rounded"' $1 == name { print rounded($2) }' "$2"
}

# The last column of each row that begins with names of ratios, and the table of static layers.
fill_ratios() {
    awk -v ratios="$1" "$rounded"'
        BEGIN {
            while ((getline line < ratios) > 0) { split(line, pair, " "); of[pair[1]] = pair[2] }
            split("8 512 8192", triangles, " ")
        }
        /^\| `[a-z]/ {
            cells = split($0, cell, "|"); all = 1; values = ""
            names = split(cell[2], name, ",")
            for (i = 1; i <= names; i++) {
                gsub(/[` ]/, "", name[i])
                if (!(name[i] in of)) { all = 0; break }
                values = values (i > 1 ? ", " : "") rounded(of[name[i]])
            }
            if (all) {
                cell[cells - 1] = " " values " "
                for (i = 2; i < cells; i++) printf "|%s", cell[i]
                print "|"
                next
            }
        }
        /^\| [0-9]+ texels \|/ {
            split($0, cell, " ")
            printf "| %s texels |", cell[2]
            for (i = 1; i <= 3; i++)
                printf " %s |", rounded(of["static_layer_vs_redraw_" cell[2] "_" triangles[i]])
            print ""
            next
        }
        { print }' "$2" >"$made/page"
    cp "$made/page" "$2"
}

# Least and greatest of those that scatter most and least, over all runs.
scatter() {
    awk -v runs="$1" "$rounded"'
        { if (!($1 in least) || $2 < least[$1]) least[$1] = $2; if ($2 > most[$1]) most[$1] = $2 }
        END {
            count = split("all_moving_vs_textbook one_moving_vs_all_moving auto_vs_textbook " \
                "four_taps_vs_3x3_loop static_layer_vs_redraw_256_512 " \
                "moved_among_1e5_vs_among_1e3 texels_a_triangle", names, " ")
            printf "in %d runs", runs
            for (i = 1; i <= count; i++) if (names[i] in least)
                printf "%s `%s` %s to %s", (i > 1 ? "," : ""), names[i],
                    rounded(least[names[i]]), rounded(most[names[i]])
            print ""
        }'
}
