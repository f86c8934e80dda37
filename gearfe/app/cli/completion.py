"""Shell completion script for verbs, options, choices and scene names, made from the argument parser."""

from importlib import resources

from ...stiffness.methods import NAMES

BASH = """\
# gearfe: completion of verbs, options and scenes.  eval "$(gearfe completion bash)"
_gearfe() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" found=""
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "{verbs}" -- "$word"))
    return
  fi
  case "${{COMP_WORDS[1]}} $before" in
{choices}
  esac
  local scene="${{COMP_WORDS[2]}}" key=""
  [ -f "$scene" ] || scene="{folder}/$scene.toml"
  case "$before" in
    --case) key='s/^ *case *= *"([^"]*)".*/\\1/p' ;;
    --pair) key='s/^.pair[.]([^]]*)].*/\\1/p' ;;
  esac
  if [ -n "$key" ]; then
    COMPREPLY=($(compgen -W "$(sed -nE "$key" "$scene" 2> /dev/null | sort -u)" -- "$word"))
    return
  fi
  case "${{COMP_WORDS[1]}}" in
{options}
  esac
  if [ "$COMP_CWORD" -eq 2 ]; then
    case "${{COMP_WORDS[1]}}" in {with_scene}) found="$found {scenes}" ;; esac
  fi
  COMPREPLY=($(compgen -W "$found" -- "$word"))
}}
complete -o default -F _gearfe gearfe
"""
ZSH = '# gearfe: completion in zsh, by its reading of bash completions.  eval "$(gearfe completion zsh)"\n'
ZSH += "autoload -Uz compinit bashcompinit\n(( $+functions[compdef] )) || compinit\nbashcompinit\n"


def _choices(verb, parser):
    """Return the lines of the script that complete the values of a verb's options."""
    for action in parser._actions:
        values = action.choices or (NAMES if action.dest == "method" and verb != "dynamics" else ())
        if values and action.option_strings:
            when = "|".join(f'"{verb} {text}"' for text in action.option_strings)
            yield f'    {when}) COMPREPLY=($(compgen -W "{" ".join(map(str, values))}" -- "$word")); return ;;'


def script(shell, verbs):
    """Return the completion script for `shell`, ``bash`` or ``zsh``, from the argparse parsers of the verbs."""
    folder = resources.files("gearfe.scene.scenes")
    scenes = sorted(place.name.removesuffix(".toml") for place in folder.iterdir() if place.name.endswith(".toml"))
    options, choices, with_scene = [], [], []
    for name, parser in verbs.items():
        words = [str(choice) for action in parser._actions if not action.option_strings for choice in action.choices or ()]
        words += [text for action in parser._actions for text in action.option_strings]
        options.append(f'    {name}) found="{" ".join(words)}" ;;')
        with_scene += [name for action in parser._actions if action.dest == "scene"]
        choices += _choices(name, parser)
    parts = {"verbs": " ".join(verbs), "choices": "\n".join(choices), "options": "\n".join(options)}
    bash = BASH.format(**parts, with_scene="|".join(with_scene), scenes=" ".join(scenes), folder=folder)
    return bash if shell == "bash" else ZSH + bash
