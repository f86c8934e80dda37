"""``python -m validation speed``: rebuild the validation pages."""

import argparse

PAGES = ("speed",)


def main():
    """Run the page asked for."""
    parser = argparse.ArgumentParser(prog="python -m validation", description="Rebuild the validation pages.")
    parser.add_argument("page", choices=PAGES, help="speed: seconds against error of every method")
    page = parser.parse_args().page
    if page == "speed":
        from .speed import run

        run()


if __name__ == "__main__":
    main()
