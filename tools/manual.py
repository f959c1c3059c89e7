#!/usr/bin/env python3
# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""manual.py PROGRAM CHECKER FOLDER [--mpi MPI_PROGRAM] [--check]   writes the man pages of the
programs, one for each command of the first, and its completions for bash, zsh and fish, from what
--help says; that of holdfast-mpi only if it is given, as not every build has it. With --check
nothing is written; exits 1 if a file in FOLDER is not what would be written."""
import pathlib
import re
import subprocess
import sys

# The titles of lists, as holdfast and as CLI11 by itself (holdfast-mpi) write them.
SECTIONS = {'Arguments': 'ARGUMENTS', 'Positionals': 'ARGUMENTS', 'Options': 'OPTIONS',
            'Commands': 'COMMANDS', 'Subcommands': 'COMMANDS'}
FILE_TYPES = {'FILE', 'FOLDER', 'FROM', 'START', 'STEPS.json', 'TARGET', 'TO'}
CHECKER = 'holdfast-checker'
MPI = 'holdfast-mpi'


class Entry:
    """A line of a list: an option, an argument or a command."""

    def __init__(self, head, text):
        words = head.replace(', -', ',-').split()
        self.names = words[0].split(',')
        self.rest = words[1:]  # What stands behind the names: type, REQUIRED, ...
        self.text = text
        self.values = []  # All that are allowed, where they are words.

    @property
    def type(self):
        """The name of the value, or None for a flag; without its default and range."""
        kind = [word for word in self.rest if word not in ('REQUIRED', '...')]
        return re.split('[=:]', kind[0])[0] if kind else None

    @property
    def shown(self):
        words = [word for word in self.rest if word != 'REQUIRED']
        return ' '.join([', '.join(self.names)] + words).replace('INT:INT', 'INT').replace(
            'FLOAT:FLOAT', 'FLOAT')

    @property
    def is_repeated(self):
        return '...' in self.rest


class Page:
    """One --help: what the command does, how it is used, its lists, what stands below them."""

    def __init__(self, text):
        head, _, tail = text.partition('\nUsage: ')
        self.summary = ' '.join(head.split()).rstrip('.')
        self.usage, _, tail = tail.partition('\n')
        self.lists = {}
        self.examples = self.exits = ''
        notes = []
        for block in tail.strip('\n').split('\n\n'):
            title, _, lines = block.strip('\n').partition(':\n')
            if title in SECTIONS:
                self.lists[SECTIONS[title]] = entries_of(lines)
            elif title == 'Examples':
                self.examples = lines
            elif title == 'Exit status':
                self.exits = lines
            else:
                notes.append(block)
        self.notes = '\n\n'.join(notes)

    def options(self):
        return self.lists.get('OPTIONS', [])

    def arguments(self):
        return self.lists.get('ARGUMENTS', [])

    def commands(self):
        return self.lists.get('COMMANDS', [])


def entries_of(lines):
    """Heads stand in column 2, texts further right, on the next line if the head is long."""
    entries = []
    for line in lines.split('\n'):
        if line.startswith(' ' * 10):
            entries[-1].text = (entries[-1].text + ' ' + line.strip()).strip()
        else:
            head, _, text = line.strip().partition('  ')
            entries.append(Entry(head, text.strip()))
    return entries


def output_of(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


def ask_values(program, command, entry):
    """Words of a type such as all|broken|N; or the program names those that it allows when it is
    given another."""
    entry.values = [word for word in (entry.type or '').split('|')
                    if re.fullmatch('[a-z][a-z-]*', word)]
    if entry.type == 'NAME':
        said = output_of(program, command, entry.names[-1], '?', '-')
        words = re.search(r': expected (.*), found ', said)
        entry.values = re.split(', | or ', words[1]) if words else []


def read_pages(program):
    """The --help of the program itself and of its commands, by their names."""
    pages = {'': Page(output_of(program, '--help'))}
    for command in pages[''].commands():
        pages[command.names[0]] = Page(output_of(program, command.names[0], '--help'))
    return pages


def read_pages_with_values(program):
    pages = read_pages(program)
    for name, page in pages.items():
        for entry in page.options() if name else []:
            ask_values(program, name, entry)
    families = output_of(program, 'generate', '?', '1')
    pages['generate'].arguments()[0].values = re.search('there are (.*)', families)[1].split(', ')
    return pages


# Man pages.

def roff(text):
    text = text.replace('\\', '\\e').replace('-', '\\-')
    return re.sub(r"^([.'])", r'\\&\1', text, flags=re.MULTILINE)


def roff_list(entries):
    return ''.join(f'.TP\n.B {roff(entry.shown)}\n{roff(entry.text)}\n' for entry in entries)


def roff_head(name, version, summary):
    return (f'.\\" Written by tools/manual.py from what --help says.\n'
            f'.TH {name.upper()} 1 "" "holdfast {version}" "User Commands"\n'
            f'.SH NAME\n{name} \\- {roff(summary)}\n')


def roff_preformatted(text):
    return f'.PP\n.nf\n{roff(text)}\n.fi\n' if text else ''


def roff_section(title, text):
    return f'.SH {title}\n{text}' if text else ''


def roff_lists(page):
    return (roff_section('ARGUMENTS', roff_list(page.arguments())) +
            roff_section('OPTIONS', roff_list(page.options())))


def command_page(program, name, page, version):
    """The man page of one command, as holdfast-check.1."""
    text = roff_head(f'{program}-{name}', version, page.summary[0].lower() + page.summary[1:])
    text += f'.SH SYNOPSIS\n.B {roff(page.usage)}\n.SH DESCRIPTION\n{roff(page.summary)}.\n'
    text += roff_preformatted(page.notes) + roff_lists(page)
    text += roff_section('EXAMPLES', roff_preformatted(page.examples))
    text += roff_section('EXIT STATUS', roff_preformatted(page.exits))
    return text + f'.SH SEE ALSO\n.BR {roff(program)} (1)\n'


def main_page(program, summary, pages, version, others):
    """The man page of a program whose commands have pages of their own."""
    page = pages['']
    text = roff_head(program, version, summary)
    text += f'.SH SYNOPSIS\n.B {roff(program)}\nCOMMAND [OPTIONS] ARGUMENTS\n'
    text += f'.SH DESCRIPTION\n{roff(page.summary)}.\n' + roff_preformatted(page.notes)
    text += roff_section('COMMANDS', roff_list(page.commands())) + roff_lists(page)
    text += roff_section('EXAMPLES', roff_preformatted(page.examples))
    names = [f'{program}-{command.names[0]}' for command in page.commands()] + others
    return text + '.SH SEE ALSO\n' + ',\n'.join(f'.BR {roff(name)} (1)' for name in names) + '\n'


def whole_page(program, summary, pages, version, other):
    """One man page for a program and its commands."""
    page = pages['']
    text = roff_head(program, version, summary)
    text += f'.SH SYNOPSIS\n.B {roff(program)}\nCOMMAND [OPTIONS] ARGUMENTS\n'
    text += f'.SH DESCRIPTION\n{roff(page.summary)}.\n' + roff_preformatted(page.notes)
    text += roff_section('OPTIONS', roff_list(page.options())) + '.SH COMMANDS\n'
    for command in page.commands():
        one = pages[command.names[0]]
        text += f'.SS {roff(one.usage)}\n{roff(one.summary)}.\n'
        text += roff_list(one.arguments()) + roff_list(one.options())
        text += roff_preformatted(one.notes)
    return text + f'.SH SEE ALSO\n.BR {roff(other)} (1)\n'


def checker_page(help_text, version):
    """Its help is paragraphs, the later ones with a heading each."""
    usage, summary, *parts = help_text.strip().split('\n\n')
    text = roff_head(CHECKER, version, 'prove a certificate of holdfast again')
    text += f'.SH SYNOPSIS\n.B {roff(usage.removeprefix("usage: "))}\n'
    text += f'.SH DESCRIPTION\n{roff(summary)}\n'
    for part in parts:
        heading, _, lines = part.partition(':\n')
        text += roff_section(heading.upper(), roff_preformatted(lines))
    return text + '.SH SEE ALSO\n.BR holdfast (1)\n'


# Completions.

def all_names(entries):
    return [name for entry in entries for name in entry.names]


def bash_completion(pages):
    commands = [command for command in pages if command]
    cases = ''
    for command in commands:
        page = pages[command]
        values = ''
        for entry in page.options():
            if entry.type:
                what = (f'words="{" ".join(entry.values)}"' if entry.values else
                        'files=1' if entry.type in FILE_TYPES else ':')
                values += f'        {"|".join(entry.names)}) {what} ;;\n'
        words = ' '.join(all_names(page.options()))
        first = page.arguments()[:1]
        known = first and first[0].values
        other = f'words="{" ".join(known)}"' if known else 'files=1' if first else ':'
        values += f'        *) if [[ $current == -* ]]; then words="{words}"; else {other}; fi ;;\n'
        cases += f'    {command})\n      case $previous in\n{values}      esac\n      ;;\n'
    top = ' '.join(commands + all_names(pages[''].options()))
    return f'''# Completions of holdfast for bash, by tools/manual.py from --help.
_holdfast() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  local words='' files=''
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "{top}" -- "$current")
    return
  fi
  case ${{COMP_WORDS[1]}} in
{cases}  esac
  [ -z "$words" ] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  if [ -n "$files" ]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}}
complete -F _holdfast holdfast
'''


def zsh_quoted(text):
    return re.sub(r'([\[\]:])', r'\\\1', text).replace("'", "'\\''")


def zsh_action(entry):
    if entry.values:
        return '(' + ' '.join(entry.values) + ')'
    return '_files' if entry.type in FILE_TYPES or entry.names[0] in FILE_TYPES else ' '


def zsh_option(entry):
    value = f':{entry.type}:{zsh_action(entry)}' if entry.type else ''
    star = '*' if entry.is_repeated else ''
    return ''.join(f"        '{star}{name}[{zsh_quoted(entry.text)}]{value}' \\\n"
                   for name in entry.names)


def zsh_argument(entry):
    star = '*' if entry.is_repeated else ''
    return f"        '{star}:{entry.names[0]}:{zsh_action(entry)}' \\\n"


def zsh_completion(pages):
    commands = ''
    cases = ''
    for command in pages[''].commands():
        name = command.names[0]
        commands += f"        '{name}:{zsh_quoted(command.text)}'\n"
        lines = ''.join(zsh_option(entry) for entry in pages[name].options())
        lines += ''.join(zsh_argument(entry) for entry in pages[name].arguments())
        cases += f'    {name})\n      _arguments \\\n{lines[:-3]}\n      ;;\n'
    top = ''.join(zsh_option(entry) for entry in pages[''].options())
    return f'''#compdef holdfast
# Completions of holdfast for zsh, by tools/manual.py from --help.
_holdfast() {{
  local context state state_descr line
  typeset -A opt_args
  _arguments -C \\
{top}        '1:command:->command' \\
        '*::argument:->argument'
  case $state in
  command)
    local -a commands
    commands=(
{commands}    )
    _describe command commands
    ;;
  argument)
    case $line[1] in
{cases}    esac
    ;;
  esac
}}
_holdfast "$@"
'''


def fish_quoted(text):
    return "'" + text.replace('\\', '\\\\').replace("'", "\\'") + "'"


def fish_option(condition, entry):
    names = ' '.join(f'-l {name[2:]}' if name.startswith('--') else f'-s {name[1:]}'
                     for name in entry.names)
    value = ''
    if entry.values:
        value = f' -x -a {fish_quoted(" ".join(entry.values))}'
    elif entry.type:
        value = ' -r -F' if entry.type in FILE_TYPES else ' -x'
    return f'complete -c holdfast -n {condition} {names}{value} -d {fish_quoted(entry.text)}\n'


def fish_completion(pages):
    text = ('# Completions of holdfast for fish, by tools/manual.py from --help.\n'
            'complete -c holdfast -n __fish_use_subcommand -f\n')
    for entry in pages[''].options():
        text += fish_option('__fish_use_subcommand', entry)
    for command in pages[''].commands():
        name = command.names[0]
        text += (f'complete -c holdfast -n __fish_use_subcommand -a {name} '
                 f'-d {fish_quoted(command.text)}\n')
        condition = f"'__fish_seen_subcommand_from {name}'"
        text += ''.join(fish_option(condition, entry) for entry in pages[name].options())
        words = [word for entry in pages[name].arguments()[:1] for word in entry.values]
        if words:
            text += f'complete -c holdfast -n {condition} -f -a {fish_quoted(" ".join(words))}\n'
    return text


def main():
    program, checker, folder = sys.argv[1:4]
    pages = read_pages_with_values(program)
    version = output_of(program, '--version').split()[1]
    files = {'holdfast.1': main_page('holdfast', 'will a modular robot hold?', pages, version,
                                     [CHECKER]),
             **{f'holdfast-{name}.1': command_page('holdfast', name, page, version)
                for name, page in pages.items() if name},
             f'{CHECKER}.1': checker_page(output_of(checker, '--help'), version),
             'holdfast.bash': bash_completion(pages),
             '_holdfast': zsh_completion(pages),
             'holdfast.fish': fish_completion(pages)}
    if '--mpi' in sys.argv:
        mpi = sys.argv[sys.argv.index('--mpi') + 1]
        files[f'{MPI}.1'] = whole_page(
            MPI, 'will a modular robot hold that is too large for one machine?', read_pages(mpi),
            output_of(mpi, '--version').split()[1], 'holdfast')
    stale = []
    for name, text in files.items():
        path = pathlib.Path(folder) / name
        if '--check' not in sys.argv:
            path.write_text(text)
        elif not path.is_file() or path.read_text() != text:
            stale.append(str(path))
    if stale:
        print(f'not what --help says: {", ".join(stale)}; ./dev manual writes them anew')
    sys.exit(1 if stale else 0)


if __name__ == '__main__':
    main()
