"""Potential-energy flexibilities of one gear tooth, in closed form."""
