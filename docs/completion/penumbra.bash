# Completion of penumbra for bash; zsh reads it too after `autoload -U bashcompinit && bashcompinit`.
# Commands and options are what --help prints, so this file never lags behind the program.
_penumbra() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
    local program=${COMP_WORDS[0]}
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        local commands
        commands=$("$program" --help 2>/dev/null | sed -n '/^Commands:/,/^$/s/^  \([a-z][a-z-]*\) .*/\1/p')
        mapfile -t COMPREPLY < <(compgen -W "$commands --help --version" -- "$word")
        return
    fi
    # The names that an option takes stand behind the colon of its help, as in "(default: late): late, pbrt, off".
    if [[ $before == --* ]]; then
        local names
        names=$("$program" "$command" --help 2>/dev/null |
            awk -v option="$before" '/^  -/ { inside = index($0, option " NAME") } inside { text = text " " $0 } /^$/ { inside = 0 }
                                     END { if (sub(/.*: /, "", text) && text !~ /\)/) { gsub(/,/, "", text); print text } }')
        if [ -n "$names" ]; then
            mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word")
            return
        fi
    fi
    if [[ $word == -* ]]; then
        local options
        options=$("$program" "$command" --help 2>/dev/null | sed -n 's/^  \(-[a-z], \)\{0,1\}\(-[-a-zA-Z]*\).*/\2/p')
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
    fi
}
complete -o default -F _penumbra penumbra
